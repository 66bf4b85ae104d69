#!/usr/bin/env bash
# SPDX-FileCopyrightText: the aib authors
# SPDX-License-Identifier: MIT
#
# Gets this machine ready and configures the folder build/:
#
#   examples/setup.sh LEVEL [--only-packages | -Doption=value ...]
#
#   shell   what aib-lua is built from
#   tests   and what its tests need
#   ci      and the heavy tools of the style, package and editor checks (clang, cmake, ...)
#
# What is here is left alone, without a look at the network. What is missing comes from apt on
# Debian and Ubuntu; on any other system it is named, and the script stops with exit code 2.
set -euo pipefail
cd "$(dirname "$0")/.."

# Debian's package   what shows that it is here
shell_needs='
g++                  program c++
meson                program meson
ninja-build          program ninja
pkg-config           program pkg-config
libeigen3-dev        module eigen3 3.4
libnanoflann-dev     module nanoflann
liblua5.4-dev        module lua5.4
sol2-dev             module sol2 3.3
zlib1g-dev           module zlib
libdeflate-dev       module libdeflate
libspng-dev          module spng
libjpeg-dev          module libjpeg
nlohmann-json3-dev   module nlohmann_json
libpugixml-dev       module pugixml
libedit-dev          module libedit
'
tests_needs='
python3              program python3
doctest-dev          header doctest/doctest.h
libtinyexr-dev       header tinyexr.h
'
ci_needs='
git                  program git
clang                program clang++
clang-format         program clang-format
libclang-rt-14-dev   file /usr/lib/llvm-*/lib/clang/*/lib/linux/libclang_rt.fuzzer-x86_64.a
locales              file /usr/share/i18n/locales/de_DE
lua-check            program luacheck
cmake                program cmake
colmap               program colmap
blender              program blender
python3-numpy        python numpy
valgrind             program valgrind
doxygen              program doxygen
snakemake            program snakemake
python3-matplotlib   python matplotlib
nodejs               program node
npm                  program npm
chromium             program chromium
librsvg2-bin         program rsvg-convert
'

is_here() {  # is_here KIND NAME [VERSION]
  case $1 in
    program) command -v "$2" ;;
    module) pkg-config --exists "$2${3:+ >= $3}" || [ -d "subprojects/$2" ] ;;
    python) /usr/bin/python3 -c "import $2" ;;
    file) compgen -G "$2" ;;
    header) echo "#include <$2>" | "${CXX:-c++}" -x c++ -E - ;;
  esac >/dev/null 2>&1
}

missing_of() {  # missing_of "TABLE": the packages of a table that are not here, a line each
  local package kind name version
  while read -r package kind name version; do
    [ -z "$package" ] || is_here "$kind" "$name" "$version" || echo "$package"
  done <<<"$1"
}

as_root() {
  if [ "$(id -u)" = 0 ]; then env DEBIAN_FRONTEND=noninteractive "$@"
  else sudo env DEBIAN_FRONTEND=noninteractive "$@"; fi
}

apt() {
  as_root apt-get -qq -o DPkg::Lock::Timeout=300 "$@"
}

# sol2 is a few headers and is not in every release: where it is not, the package of Debian
# unstable fits as it is. Its source and its lists live in a folder that is thrown away; the
# address and the keys are those this machine's own apt uses for Debian. Nothing else is upgraded.
install_sol2() {
  local candidate uri
  candidate=$(apt-cache policy sol2-dev | awk '/Candidate:/ { print $2 }')
  if dpkg --compare-versions "${candidate/(none)/}" ge 3.3; then
    apt install -y --no-install-recommends sol2-dev
    return
  fi
  uri=$(apt-get indextargets --format '$(LABEL)|$(REPO_URI)' | sed -n 's/^Debian|//p' | head -n 1)
  if [ -z "$uri" ]; then
    echo "setup: no package of sol2 is known here; Meson fetches its source (subprojects/sol2.wrap)" >&2
    return
  fi
  local away
  away=$(mktemp -d)
  chmod 755 "$away"
  mkdir -p "$away/parts" "$away/lists/partial"
  echo "deb [signed-by=/usr/share/keyrings/debian-archive-keyring.gpg] $uri unstable main" \
    >"$away/parts/unstable.list"
  local only_unstable=(
    -o "Dir::Etc::SourceList=/dev/null"
    -o "Dir::Etc::SourceParts=$away/parts"
    -o "Dir::State::Lists=$away/lists"
  )
  apt "${only_unstable[@]}" update
  apt "${only_unstable[@]}" install -y --no-install-recommends sol2-dev
  as_root rm -rf "$away"
}

install() {  # install PACKAGE ...
  if ! command -v apt-get >/dev/null; then
    echo "setup: please install what these Debian packages hold, then call again: $*" >&2
    exit 2
  fi
  if [ "$(id -u)" != 0 ] && ! command -v sudo >/dev/null; then
    echo "setup: please install as root, then call again: $*" >&2
    exit 2
  fi
  echo "setup: installing $*"
  apt update || echo "setup: some package lists could not be refreshed; going on" >&2
  local package plain=()
  for package in "$@"; do [ "$package" = sol2-dev ] || plain+=("$package"); done
  [ ${#plain[@]} = 0 ] || apt install -y --no-install-recommends "${plain[@]}" >/dev/null
  case " $* " in *" sol2-dev "*) install_sol2 >/dev/null ;; esac
}

quietly() {  # quietly COMMAND ...: its output is shown only where it fails
  local log
  log=$(mktemp)
  if "$@" >"$log" 2>&1; then rm "$log"; return; fi
  cat "$log" >&2
  rm "$log"
  return 1
}

has_option() {  # has_option -Dname=value: whether build/ is configured so
  local name=${1#-D}
  grep -qE "\"name\": \"${name%%=*}\", \"value\": \"?${name#*=}\"?," build/meson-info/intro-buildoptions.json
}

configure() {  # configure HAS_NEWS -Doption=value ...
  local has_news=$1 option changed=()
  shift
  if [ ! -f build/build.ninja ]; then
    echo "setup: configuring build/ with $*"
    quietly meson setup build "$@"
    return
  fi
  for option in "$@"; do has_option "$option" || changed+=("$option"); done
  if [ "$has_news" = no ] && [ ${#changed[@]} = 0 ]; then
    echo "setup: build/ is configured with $*"
    return
  fi
  echo "setup: configuring build/ again with $*"
  # Meson remembers what it did not find. Without its memory it looks again, with the same options.
  [ "$has_news" = no ] || : >build/meson-private/coredata.dat
  quietly meson setup build --reconfigure "$@"
}

level=${1:-shell}
case $level in
  shell) needs=$shell_needs ;;
  tests) needs=$shell_needs$tests_needs ;;
  ci) needs=$shell_needs$tests_needs$ci_needs ;;
  *) echo "usage: examples/setup.sh shell|tests|ci [--only-packages | -Doption=value ...]" >&2; exit 2 ;;
esac
shift || true

has_news=no
mapfile -t missing < <(missing_of "$needs")
if [ ${#missing[@]} != 0 ]; then
  install "${missing[@]}"
  has_news=yes
fi
[ "${1:-}" = --only-packages ] || configure "$has_news" -Dsimd=native -Dlua=enabled "$@"
