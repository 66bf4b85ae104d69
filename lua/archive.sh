#!/usr/bin/env bash
# SPDX-FileCopyrightText: the aib authors
# SPDX-License-Identifier: MIT
#
# Packs aib-lua with everything that it needs, for machines where one may install nothing:
#
#   lua/archive.sh FILE.tar.gz [BUILD]
#
#   BUILD   a folder that Meson has built; without it, build-archive/ is made for any x86-64 processor
#
# The archive brings the C library and its loader along, so that the age of the other machine's system
# does not matter. The same build gives the same bytes.
set -euo pipefail
[ $# -ge 1 ] || { echo "usage: lua/archive.sh FILE.tar.gz [BUILD]" >&2; exit 2; }
file=$(realpath -m "$1")
cd "$(dirname "$0")/.."
build=${2:-build-archive}
if [ $# = 1 ]; then
  [ -f build-archive/build.ninja ] ||
    meson setup build-archive -Dlua=enabled -Dtests=disabled -Dprefix=/usr >/dev/null
  ninja -C build-archive
fi

away=$(mktemp -d)
trap 'rm -rf "$away"' EXIT
version=$(sed -n "s/^ *version: '\(.*\)',/\1/p" meson.build | head -n 1)
name=aib-$version-linux-$(uname -m)
root=$away/$name
mkdir -p "$root/bin" "$root/lib" "$root/share/doc/licences"

meson install -C "$build" --no-rebuild --destdir "$away/installed" >/dev/null
prefix=$(dirname "$(dirname "$(find "$away/installed" -path '*/bin/aib-lua')")")
cp -r "$prefix/share/." "$root/share"
cp "$prefix/bin/aib-lua" "$root/lib/aib-lua"
strip "$root/lib/aib-lua"
cp LICENSE "$root/share/doc/licences/aib"

# "libz.so.1 => /lib/libz.so.1 (0x...)" and "/lib64/ld-linux-x86-64.so.2 (0x...)"
ldd "$root/lib/aib-lua" | grep -oE '/[^ ]+' | while read -r library; do
  cp -L "$library" "$root/lib/"
  package=$(dpkg -S "$(realpath "$library")" "$library" 2>/dev/null | head -n 1 | cut -d : -f 1) || true
  [ ! -f "/usr/share/doc/$package/copyright" ] ||
    cp "/usr/share/doc/$package/copyright" "$root/share/doc/licences/$package"
done
loader=$(basename "$(find "$root/lib" -name 'ld-linux*')")

cat >"$root/bin/aib-lua" <<END
#!/bin/sh
root=\$(dirname "\$(dirname "\$(readlink -f "\$0")")")
exec "\$root/lib/$loader" --argv0 "\$0" --library-path "\$root/lib" "\$root/lib/aib-lua" "\$@"
END
chmod -R u=rwX,go=rX "$root"
chmod +x "$root/bin/aib-lua"

mkdir -p "$(dirname "$file")"
tar -C "$away" --sort=name --mtime=@0 --owner=0 --group=0 --numeric-owner -cf - "$name" | gzip -n9 >"$file"
echo "archive: $(basename "$file"): $(du -k "$file" | cut -f 1) kB, unpacks $name/bin/aib-lua"
