# SPDX-FileCopyrightText: the aib authors
# SPDX-License-Identifier: MIT
"""Every public header includes the standard header of each standard name that it writes.

usage: includes.py SOURCE_ROOT

Together with clang, which compiles every header alone after those of Eigen and the standard library,
that tells that a header needs no other before it.
"""

import pathlib
import re
import sys

NAMES = {
    "algorithm": "all_of any_of clamp copy copy_n count_if fill find find_if max max_element min min_element"
    " minmax nth_element partition reverse set_difference sort stable_sort transform unique upper_bound lower_bound",
    "array": "array",
    "atomic": "atomic",
    "bit": "bit_cast bit_ceil bit_width countr_zero endian popcount",
    "chrono": "chrono",
    "cmath": "abs acos atan2 cbrt ceil cos exp floor fma hypot isfinite isinf isnan log log10 lround pow round"
    " sin sqrt tan",
    "concepts": "convertible_to floating_point integral same_as",
    "cstddef": "byte ptrdiff_t size_t",
    "cstdint": "int16_t int32_t int64_t int8_t uint16_t uint32_t uint64_t uint8_t",
    "cstring": "memcmp memcpy memset strlen",
    "exception": "current_exception exception_ptr rethrow_exception",
    "filesystem": "filesystem",
    "fstream": "ifstream ofstream",
    "functional": "function greater less",
    "limits": "numeric_limits",
    "map": "map",
    "memory": "make_shared make_unique shared_ptr unique_ptr",
    "mutex": "lock_guard mutex scoped_lock unique_lock",
    "numbers": "numbers",
    "numeric": "accumulate iota partial_sum reduce",
    "optional": "make_optional nullopt optional",
    "ranges": "ranges",
    "set": "set",
    "span": "span",
    "stop_token": "stop_source stop_token",
    "string": "string to_string",
    "string_view": "string_view",
    "thread": "jthread thread",
    "tuple": "tie tuple",
    "unordered_map": "unordered_map",
    "unordered_set": "unordered_set",
    "utility": "exchange forward in_range move pair swap",
    "variant": "get_if variant visit",
    "vector": "vector",
}
HEADER_OF = {name: header for header, names in NAMES.items() for name in names.split()}
GIVES = {"ranges": {"concepts"}}


def missing_of(text):
    code = re.sub(r"//.*", "", text)
    included = set(re.findall(r"#include <([^>]+)>", code))
    for header in list(included):
        included |= GIVES.get(header, set())
    used = {HEADER_OF[name] for name in re.findall(r"\bstd::([a-z_0-9]+)", code) if name in HEADER_OF}
    return sorted(used - included)


def main(root):
    n_headers = n_faults = 0
    for path in sorted(pathlib.Path(root, "include", "aib").glob("*/*.hpp")):
        n_headers += 1
        missing = missing_of(path.read_text())
        if missing:
            n_faults += 1
            print(f"{path.relative_to(root)}: include {' '.join(f'<{header}>' for header in missing)}")
    print(f"{n_headers - n_faults} passed, {n_faults} failed")
    return 1 if n_faults or not n_headers else 0


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]))
