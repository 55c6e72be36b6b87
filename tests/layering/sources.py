# SPDX-License-Identifier: MIT
"""Reads #include lines of C++ and GLSL, and names of the standard library whose header no file of this
tree includes: they compile for as long as another header happens to bring them, which differs between
releases of a compiler."""

import os
import pathlib
import posixpath
import re
from dataclasses import dataclass

# A string ends with its line where its quote stands alone.
STRING = r'"(?:\\.|[^"\\\n])*["\n]?'
STRING_OR_COMMENT = re.compile(rf"{STRING}|//[^\n]*|/\*.*?(?:\*/|\Z)", re.DOTALL)
INCLUDE = re.compile(r'^[ \t]*#[ \t]*include[ \t]*(?:"([^"\n]*)"|<([^>\n]*)>)?', re.MULTILINE)
STRING_OR_NAME = re.compile(rf"{STRING}|(std::)?(\w+)", re.ASCII | re.DOTALL)

# Names that this tree uses or is likely to use. Names that several headers declare (begin, hash, swap of
# one type) are left out; abs is <cmath>'s, as it is used for floats.
HEADER_NAMES = {
    "algorithm":
        "all_of any_of none_of for_each find find_if find_if_not find_first_of adjacent_find count count_if "
        "mismatch equal search copy copy_if copy_n copy_backward transform replace replace_if fill fill_n "
        "generate generate_n remove_if unique reverse rotate shuffle sample partition stable_partition "
        "is_sorted sort stable_sort partial_sort nth_element lower_bound upper_bound equal_range "
        "binary_search merge includes set_difference set_intersection set_union max min minmax min_element "
        "max_element minmax_element clamp lexicographical_compare",
    "array": "array to_array",
    "atomic": "atomic atomic_flag memory_order_relaxed",
    "bit": "bit_cast bit_ceil bit_width countl_zero countr_zero has_single_bit popcount",
    "cctype": "isalnum isalpha isdigit isspace tolower toupper",
    "charconv": "from_chars to_chars",
    "chrono": "chrono",
    "cmath":
        "abs acos asin atan atan2 cbrt ceil copysign cos exp exp2 floor fma fmod frexp hypot ilogb isfinite "
        "isinf isnan ldexp lerp log log10 log2 lround nextafter pow round signbit sin sqrt tan trunc",
    "concepts": "convertible_to derived_from floating_point integral invocable same_as",
    "condition_variable": "condition_variable",
    "cstddef": "nullptr_t ptrdiff_t",
    "cstdint": "int8_t int16_t int32_t int64_t uint8_t uint16_t uint32_t uint64_t uintptr_t",
    "cstdio": "fclose fflush fgets fopen fprintf fputs fwrite printf snprintf",
    "cstdlib": "abort atoi exit getenv strtod system",
    "cstring": "memcmp memcpy memmove memset strcmp strerror strlen",
    "deque": "deque",
    "exception": "current_exception exception exception_ptr terminate",
    "filesystem": "filesystem",
    "fstream": "fstream ifstream ofstream",
    "functional": "function greater invoke less plus ref reference_wrapper",
    "future": "async future promise",
    "initializer_list": "initializer_list",
    "iomanip": "setprecision setw",
    "iostream": "cerr cin cout",
    "iterator":
        "advance back_inserter distance input_iterator_tag inserter istreambuf_iterator make_move_iterator "
        "next ostream_iterator prev",
    "limits": "numeric_limits",
    "list": "list",
    "map": "map multimap",
    "memory": "addressof make_shared make_unique shared_ptr unique_ptr weak_ptr",
    "mutex": "call_once lock_guard mutex scoped_lock unique_lock",
    "numbers": "numbers",
    "numeric": "accumulate gcd inner_product iota lcm midpoint partial_sum reduce",
    "optional": "make_optional nullopt optional",
    "ostream": "ostream",
    "queue": "priority_queue queue",
    "random":
        "minstd_rand mt19937 mt19937_64 normal_distribution uniform_int_distribution "
        "uniform_real_distribution",
    "ranges": "ranges views",
    "regex": "regex regex_match regex_replace regex_search smatch sregex_iterator",
    "set": "multiset set",
    "span": "as_bytes as_writable_bytes span",
    "sstream": "istringstream ostringstream stringstream",
    "stdexcept": "invalid_argument logic_error out_of_range runtime_error",
    "string": "getline stod stoi stoul string to_string",
    "string_view": "string_view",
    "system_error": "errc error_code generic_category system_error",
    "thread": "jthread this_thread thread",
    "tuple": "make_tuple tie tuple",
    "type_traits":
        "conditional_t decay_t enable_if_t invoke_result_t is_const_v is_convertible_v is_enum_v "
        "is_floating_point_v is_integral_v is_same_v is_signed_v is_trivially_copyable_v make_unsigned_t "
        "remove_const_t remove_cvref_t remove_reference_t underlying_type_t",
    "unordered_map": "unordered_map",
    "unordered_set": "unordered_set",
    "utility":
        "as_const cmp_less declval exchange forward in_range index_sequence make_pair move pair",
    "variant": "get_if holds_alternative monostate variant visit",
    "vector": "vector",
}
HEADERS = {name: header for header, names in HEADER_NAMES.items() for name in names.split()}


@dataclass(frozen=True)
class Include:
    file: str  # the including file, from the repository root
    line: int
    target: str  # the text between the quotes or brackets; empty for a macro
    quoted: bool


def read(path):
    return pathlib.Path(path).read_text(encoding="latin-1")


def list_files(root, folder):
    """Paths from the root, with '/'."""
    return sorted(pathlib.Path(top, name).relative_to(root).as_posix()
                  for top, _, names in os.walk(root / folder) for name in names)


def blank_comments(text):
    """The text with every comment turned into spaces; line ends and strings stay."""
    return STRING_OR_COMMENT.sub(
        lambda found: found[0] if found[0][0] == '"' else re.sub(r"[^\n]", " ", found[0]), text)


def read_includes(file, code):
    """The includes of a file's text without comments, in order. Those that the preprocessor would skip
    count, so that a dependence cannot hide behind an #if."""
    return [Include(file, 1 + code.count("\n", 0, found.start()), found[1] or found[2] or "",
                    found[1] is not None)
            for found in INCLUDE.finditer(code)]


def read_standard_names(code):
    """The names after "std::", and the integer types of <cstdint> with or without it."""
    return {found[2] for found in STRING_OR_NAME.finditer(code)
            if found[1] or HEADERS.get(found[2]) == "cstdint"}


class Sources:
    """The C++ files below some folders: what each includes and names."""

    def __init__(self, root, *folders):
        self.files = [file for folder in folders for file in list_files(root, folder)
                      if file.endswith((".cpp", ".h", ".hpp"))]
        codes = {file: blank_comments(read(root / file)) for file in self.files}
        self.includes = {file: read_includes(file, code) for file, code in codes.items()}
        self.names = {file: read_standard_names(code) for file, code in codes.items()}

    def add_headers(self, file, headers, visited):
        """Adds what a file includes in brackets, and what the files of the tree do that it includes."""
        visited.add(file)
        for include in self.includes[file]:
            if not include.quoted:  # a header for C has the C library's
                headers.add("cstdint" if include.target == "stdint.h" else include.target)
                continue
            for folder in (posixpath.dirname(file), "", "shaders"):
                path = posixpath.normpath(posixpath.join(folder, include.target))
                if path in self.includes:
                    if path not in visited:
                        self.add_headers(path, headers, visited)
                    break

    def find_missing_headers(self):
        """A sentence for each name whose header neither its file nor any that it includes includes."""
        for file in self.files:
            headers = set()
            self.add_headers(file, headers, set())
            for name in sorted(self.names[file]):
                if HEADERS.get(name, name) not in headers and name in HEADERS:
                    yield f"{file} uses std::{name} without <{HEADERS[name]}>"
