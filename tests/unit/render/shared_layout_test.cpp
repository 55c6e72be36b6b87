// SPDX-License-Identifier: MIT
// The structs of shaders/**_shared.h are compiled twice. C++ packs their members, which are all
// aligned to 4 bytes, and each header asserts the sizes it gets; here glslang reports where it
// puts every member.
#include "engine/math/math.h"
#include "tests/support/temp_folder.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cstddef>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <memory>
#include <optional>
#include <regex>
#include <string>
#include <unistd.h>
#include <utility>
#include <vector>

namespace shutter::shader {

namespace {

namespace fs = std::filesystem;

static_assert(alignof(math::vec2) == 4 && alignof(math::vec3) == 4);
static_assert(alignof(math::vec4) == 4 && alignof(math::mat4) == 4);

struct Member {
    std::string type;
    std::string name;
    size_t count = 1; ///< of an array's elements
    size_t offset = 0;
};

struct Struct {
    std::string header; ///< below shaders/
    std::string name;
    std::vector<Member> members;
    size_t bytes = 0;
    std::optional<size_t> assertedBytes; ///< by the header, in C++
};

const fs::path kShaders = fs::path(SHUTTER_SOURCE_DIR) / "shaders";

std::string readText(const fs::path& file) {
    std::ifstream stream(file);
    return {std::istreambuf_iterator<char>(stream), {}};
}

std::map<std::string, size_t>& sizesOfTypes() {
    static std::map<std::string, size_t> sizes = [] {
        std::map<std::string, size_t> plain = {{"float", 4}, {"int", 4}, {"uint", 4}, {"mat4", 64}};
        for (size_t count = 2; count <= 4; ++count)
            for (const char* vector : {"vec", "ivec", "uvec"})
                plain[vector + std::to_string(count)] = 4 * count;
        return plain;
    }();
    return sizes;
}

/// "4", or a constant of a header: SHUTTER_CONST uint kName = 4u.
size_t parseCount(const std::string& text, const std::string& header) {
    if (std::isdigit(static_cast<unsigned char>(text.front())) != 0)
        return std::stoul(text);
    std::smatch constant;
    const std::regex pattern("SHUTTER_CONST uint " + text + R"( = (\d+)u)");
    EXPECT_TRUE(std::regex_search(header, constant, pattern)) << text;
    return constant.empty() ? 1 : std::stoul(constant[1]);
}

/// Packs the members as C++ does.
Struct parseStruct(const std::string& name, const std::string& body, const std::string& header) {
    static const std::regex kMember(R"((\w+)\s+(\w+)(?:\[(\w+)\])?;)");
    static const std::regex kComment("//[^\n]*");
    const std::string code = std::regex_replace(body, kComment, "");
    Struct type{.header = {}, .name = name, .members = {}, .bytes = 0, .assertedBytes = {}};
    for (std::sregex_iterator at(code.begin(), code.end(), kMember), end; at != end; ++at) {
        const std::smatch& found = *at;
        Member member{found[1], found[2], 1, type.bytes};
        if (found[3].matched)
            member.count = parseCount(found[3], header);
        EXPECT_TRUE(sizesOfTypes().contains(member.type))
            << name << "." << member.name << ": " << member.type;
        type.bytes += member.count * sizesOfTypes()[member.type];
        type.members.push_back(std::move(member));
    }
    sizesOfTypes()[name] = type.bytes;
    return type;
}

/// Those that a header includes come first.
void addHeader(const std::string& path, std::vector<std::string>& done, std::vector<Struct>& all) {
    if (std::find(done.begin(), done.end(), path) != done.end())
        return;
    done.push_back(path);
    const std::string text = readText(kShaders / path);
    static const std::regex kInclude(R"x(#include "(\w+/\w+_shared\.h)")x");
    for (std::sregex_iterator at(text.begin(), text.end(), kInclude), end; at != end; ++at)
        addHeader((*at)[1], done, all);
    static const std::regex kStruct(R"(struct (\w+) \{\n((?:[^}])*)\};)");
    for (std::sregex_iterator at(text.begin(), text.end(), kStruct), end; at != end; ++at) {
        Struct type = parseStruct((*at)[1], (*at)[2], text);
        type.header = path;
        std::smatch asserted;
        const std::regex pattern(
            R"(static_assert\(sizeof\(shutter::shader::)" + type.name + R"(\) == (\d+)\))"
        );
        if (std::regex_search(text, asserted, pattern))
            type.assertedBytes = std::stoul(asserted[1]);
        all.push_back(std::move(type));
    }
}

const std::vector<Struct>& listStructs() {
    static const std::vector<Struct> kStructs = [] {
        std::vector<std::string> headers;
        for (const auto& entry : fs::recursive_directory_iterator(kShaders))
            if (entry.path().filename().string().ends_with("_shared.h"))
                headers.push_back(fs::relative(entry.path(), kShaders).generic_string());
        std::sort(headers.begin(), headers.end());
        std::vector<std::string> done;
        std::vector<Struct> all;
        for (const std::string& header : headers)
            addHeader(header, done, all);
        return all;
    }();
    return kStructs;
}

/// Reflection lists scalars, vectors and matrices: the first of a member that is an array or
/// struct.
std::string leafOf(const Member& member) {
    const std::string name = member.name + (member.count > 1 ? "[0]" : "");
    for (const Struct& type : listStructs())
        if (type.name == member.type)
            return name + "." + leafOf(type.members.front());
    return name;
}

/// Two of each struct in a buffer of its own; touches every member, so that reflection lists it.
std::string writeShader() {
    std::string text = "#version 460\n"
                       "#extension GL_GOOGLE_include_directive : require\n"
                       "#extension GL_EXT_scalar_block_layout : require\n"
                       "layout(local_size_x = 1) in;\n";
    std::string body;
    for (const Struct& type : listStructs()) {
        text += fmt::format(
            "#include \"{0}\"\n"
            "layout(binding = 0, scalar) buffer Block{1} {{ {1} value{1}; {1} next{1}; }};\n",
            type.header,
            type.name
        );
        for (const Member& member : type.members)
            body += fmt::format("    value{1}.{0} = next{1}.{0};\n", leafOf(member), type.name);
    }
    return text + "void main() {\n" + body + "}\n";
}

std::string readOutput(const std::string& command) {
    std::string output;
    const std::unique_ptr<std::FILE, int (*)(std::FILE*)> pipe(popen(command.c_str(), "r"), pclose);
    std::array<char, 4096> chunk{};
    while (pipe && std::fgets(chunk.data(), chunk.size(), pipe.get()))
        output += chunk.data();
    return output;
}

/// Offsets by "valueStruct.member" and "nextStruct.member", and bytes by "BlockStruct".
std::map<std::string, size_t> reflect() {
    const test::TempFolder folder;
    const std::string output = readOutput(fmt::format(
        "'{}' -V --target-env vulkan1.3 -q '-I{}' -o '{}' '{}' 2>&1",
        SHUTTER_GLSLANG,
        kShaders.string(),
        (folder.path() / "layout.spv").string(),
        folder.write("layout.comp", writeShader()).string()
    ));
    std::map<std::string, size_t> offsets;
    static const std::regex kMember(R"(([\w.\[\]]+): offset (\d+), type)");
    static const std::regex kBlock(R"((Block\w+): offset -1, type \w+, size (\d+))");
    for (const std::regex& pattern : {kMember, kBlock})
        for (std::sregex_iterator at(output.begin(), output.end(), pattern), end; at != end; ++at)
            offsets[(*at)[1].str()] = std::stoul((*at)[2]);
    EXPECT_FALSE(offsets.empty()) << output;
    return offsets;
}

} // namespace

TEST(SharedLayout, GlslPutsEveryMemberWhereCppDoes) {
    if (access(SHUTTER_GLSLANG, X_OK) != 0)
        GTEST_SKIP() << "glslang is not installed";
    const std::map<std::string, size_t> offsets = reflect();
    for (const Struct& type : listStructs()) {
        SCOPED_TRACE(type.name);
        for (const Member& member : type.members) {
            const std::string leaf = type.name + "." + leafOf(member);
            // Without "[0]" where reflection names an array by its variable.
            const std::string bare = std::regex_replace(leaf, std::regex(R"(\[0\])"), "");
            const auto find = [&](const std::string& prefix) {
                const auto found = offsets.find(prefix + leaf);
                return found != offsets.end() ? found : offsets.find(prefix + bare);
            };
            const auto first = find("value");
            const auto second = find("next");
            ASSERT_TRUE(first != offsets.end() && second != offsets.end()) << leaf;
            EXPECT_EQ(first->second, member.offset) << leaf;
            EXPECT_EQ(second->second, type.bytes + member.offset) << leaf << ", the next one's";
        }
        EXPECT_EQ(offsets.at("Block" + type.name), 2 * type.bytes);
    }
}

TEST(SharedLayout, HeadersAssertTheSizesOfCpp) {
    EXPECT_GT(listStructs().size(), 40u);
    for (const Struct& type : listStructs()) {
        EXPECT_TRUE(type.assertedBytes) << type.header << " asserts no size of " << type.name;
        EXPECT_EQ(type.assertedBytes.value_or(type.bytes), type.bytes) << type.name;
    }
}

} // namespace shutter::shader
