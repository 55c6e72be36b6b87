// SPDX-License-Identifier: MIT
#include "tests/layering/standard_headers.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <fstream>
#include <functional>
#include <iterator>
#include <optional>
#include <set>
#include <sstream>
#include <utility>

namespace shutter::layering {

namespace {

struct HeaderRow {
    std::string_view header;
    std::string_view names; ///< separated by spaces
};

/// Names that this tree uses or is likely to use. Names that several headers declare (begin, hash,
/// swap of one type) are left out; abs is <cmath>'s, as it is used for floats.
constexpr std::array kRows = {
    HeaderRow{
        "algorithm",
        "all_of any_of none_of for_each find find_if find_if_not find_first_of adjacent_find count "
        "count_if mismatch equal search copy copy_if copy_n copy_backward transform replace "
        "replace_if fill fill_n generate generate_n remove_if unique reverse rotate shuffle sample "
        "partition stable_partition is_sorted sort stable_sort partial_sort nth_element "
        "lower_bound upper_bound equal_range binary_search merge includes set_difference "
        "set_intersection set_union max min minmax min_element max_element minmax_element clamp "
        "lexicographical_compare"},
    HeaderRow{"array", "array to_array"},
    HeaderRow{"atomic", "atomic atomic_flag memory_order_relaxed"},
    HeaderRow{"bit", "bit_cast bit_ceil bit_width countl_zero countr_zero has_single_bit popcount"},
    HeaderRow{"cctype", "isalnum isalpha isdigit isspace tolower toupper"},
    HeaderRow{"charconv", "from_chars to_chars"},
    HeaderRow{"chrono", "chrono"},
    HeaderRow{
        "cmath",
        "abs acos asin atan atan2 cbrt ceil copysign cos exp exp2 floor fma fmod frexp hypot ilogb "
        "isfinite isinf isnan ldexp lerp log log10 log2 lround nextafter pow round signbit sin "
        "sqrt tan trunc"},
    HeaderRow{"concepts", "convertible_to derived_from floating_point integral invocable same_as"},
    HeaderRow{"condition_variable", "condition_variable"},
    HeaderRow{"cstddef", "nullptr_t ptrdiff_t"},
    HeaderRow{
        "cstdint", "int8_t int16_t int32_t int64_t uint8_t uint16_t uint32_t uint64_t uintptr_t"},
    HeaderRow{"cstdio", "fclose fflush fgets fopen fprintf fputs fwrite printf snprintf"},
    HeaderRow{"cstdlib", "abort atoi exit getenv strtod system"},
    HeaderRow{"cstring", "memcmp memcpy memmove memset strcmp strerror strlen"},
    HeaderRow{"deque", "deque"},
    HeaderRow{"exception", "current_exception exception exception_ptr terminate"},
    HeaderRow{"filesystem", "filesystem"},
    HeaderRow{"fstream", "fstream ifstream ofstream"},
    HeaderRow{"functional", "function greater invoke less plus ref reference_wrapper"},
    HeaderRow{"future", "async future promise"},
    HeaderRow{"initializer_list", "initializer_list"},
    HeaderRow{"iomanip", "setprecision setw"},
    HeaderRow{"iostream", "cerr cin cout"},
    HeaderRow{
        "iterator",
        "advance back_inserter distance input_iterator_tag inserter istreambuf_iterator "
        "make_move_iterator next ostream_iterator prev"},
    HeaderRow{"limits", "numeric_limits"},
    HeaderRow{"list", "list"},
    HeaderRow{"map", "map multimap"},
    HeaderRow{"memory", "addressof make_shared make_unique shared_ptr unique_ptr weak_ptr"},
    HeaderRow{"mutex", "call_once lock_guard mutex scoped_lock unique_lock"},
    HeaderRow{"numbers", "numbers"},
    HeaderRow{"numeric", "accumulate gcd inner_product iota lcm midpoint partial_sum reduce"},
    HeaderRow{"optional", "make_optional nullopt optional"},
    HeaderRow{"ostream", "ostream"},
    HeaderRow{"queue", "priority_queue queue"},
    HeaderRow{
        "random",
        "minstd_rand mt19937 mt19937_64 normal_distribution uniform_int_distribution "
        "uniform_real_distribution"},
    HeaderRow{"ranges", "ranges views"},
    HeaderRow{"regex", "regex regex_match regex_replace regex_search smatch sregex_iterator"},
    HeaderRow{"set", "multiset set"},
    HeaderRow{"span", "as_bytes as_writable_bytes span"},
    HeaderRow{"sstream", "istringstream ostringstream stringstream"},
    HeaderRow{"stdexcept", "invalid_argument logic_error out_of_range runtime_error"},
    HeaderRow{"string", "getline stod stoi stoul string to_string"},
    HeaderRow{"string_view", "string_view"},
    HeaderRow{"system_error", "errc error_code generic_category system_error"},
    HeaderRow{"thread", "jthread this_thread thread"},
    HeaderRow{"tuple", "make_tuple tie tuple"},
    HeaderRow{
        "type_traits",
        "conditional_t decay_t enable_if_t invoke_result_t is_const_v is_convertible_v is_enum_v "
        "is_floating_point_v is_integral_v is_same_v is_signed_v is_trivially_copyable_v "
        "make_unsigned_t remove_const_t remove_cvref_t remove_reference_t underlying_type_t"},
    HeaderRow{"unordered_map", "unordered_map"},
    HeaderRow{"unordered_set", "unordered_set"},
    HeaderRow{
        "utility",
        "as_const cmp_less declval exchange forward in_range index_sequence make_pair move pair"},
    HeaderRow{"variant", "get_if holds_alternative monostate variant visit"},
    HeaderRow{"vector", "vector"},
};

std::map<std::string, std::string, std::less<>> indexRows() {
    std::map<std::string, std::string, std::less<>> headers;
    for (const HeaderRow& row : kRows) {
        std::istringstream names{std::string(row.names)};
        for (std::string name; names >> name;)
            headers.emplace(name, row.header);
    }
    return headers;
}

/// The header of a name, if the table has it.
std::optional<std::string_view> findHeader(std::string_view name) {
    static const auto kHeaders = indexRows();
    const auto found = kHeaders.find(name);
    if (found == kHeaders.end())
        return std::nullopt;
    return found->second;
}

bool isWordCharacter(char character) {
    return std::isalnum(static_cast<unsigned char>(character)) != 0 || character == '_';
}

bool isIntegerType(std::string_view name) {
    return findHeader(name) == "cstdint";
}

/// The file of the tree that an include names: in its folder, from the root or from shaders/.
std::optional<std::string> findFile(const SourceTree& tree, const Include& include) {
    const std::filesystem::path sameFolder = std::filesystem::path(include.file).parent_path();
    for (const auto& folder :
         {sameFolder, std::filesystem::path(), std::filesystem::path("shaders")}) {
        std::string path = (folder / include.target).lexically_normal().generic_string();
        if (tree.contains(path))
            return path;
    }
    return std::nullopt;
}

/// Adds what a file includes in brackets, and what the files of the tree do that it includes.
void addHeaders(
    const SourceTree& tree,
    const std::string& file,
    std::set<std::string>& headers,
    std::set<std::string>& visited
) {
    if (!visited.insert(file).second)
        return;
    for (const Include& include : tree.at(file).includes) {
        if (!include.quoted) // a header for C has the C library's
            headers.insert(include.target == "stdint.h" ? "cstdint" : include.target);
        else if (const auto next = findFile(tree, include))
            addHeaders(tree, *next, headers, visited);
    }
}

} // namespace

std::vector<std::string> readStandardNames(std::string_view text) {
    const std::string code = blankComments(text);
    std::set<std::string> names;
    for (size_t i = 0; i < code.size(); ++i) {
        if (code[i] == '"') { // a lone quote ends with its line
            while (++i < code.size() && code[i] != '"' && code[i] != '\n')
                i += code[i] == '\\';
            continue;
        }
        if (!isWordCharacter(code[i]))
            continue;
        const size_t start = i;
        while (i < code.size() && isWordCharacter(code[i]))
            ++i;
        std::string word = code.substr(start, i - start);
        constexpr std::string_view kPrefix = "std::";
        const bool isStandard =
            start >= kPrefix.size() &&
            std::string_view(code).substr(start - kPrefix.size(), kPrefix.size()) == kPrefix;
        if (isStandard || isIntegerType(word))
            names.insert(std::move(word));
        --i;
    }
    return {names.begin(), names.end()};
}

void addSources(SourceTree& tree, const std::filesystem::path& root, std::string_view folder) {
    for (const auto& entry : std::filesystem::recursive_directory_iterator(root / folder)) {
        const std::string extension = entry.path().extension().string();
        if (!entry.is_regular_file() ||
            (extension != ".cpp" && extension != ".h" && extension != ".hpp"))
            continue;
        const std::string path = entry.path().lexically_relative(root).generic_string();
        std::ifstream stream(entry.path(), std::ios::binary);
        const std::string text{std::istreambuf_iterator<char>(stream), {}};
        tree[path] = {readIncludes(path, text), readStandardNames(text)};
    }
}

std::vector<std::string> findMissingHeaders(const SourceTree& tree) {
    std::vector<std::string> missing;
    for (const auto& [file, source] : tree) {
        std::set<std::string> headers;
        std::set<std::string> visited;
        addHeaders(tree, file, headers, visited);
        for (const std::string& name : source.standardNames) {
            const auto header = findHeader(name);
            if (!header || headers.contains(std::string(*header)))
                continue;
            missing.push_back(
                file + " uses std::" + name + " without <" + std::string(*header) + ">"
            );
        }
    }
    return missing;
}

} // namespace shutter::layering
