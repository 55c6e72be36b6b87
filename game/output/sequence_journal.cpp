// SPDX-License-Identifier: MIT
#include "game/output/sequence_journal.h"

#include "engine/io/file_bytes.h"
#include "engine/io/uri.h"
#include "engine/json/json_file.h"
#include "game/output/render_options.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <cerrno>
#include <fcntl.h>
#include <system_error>
#include <unistd.h>

namespace shutter::game {

namespace fs = std::filesystem;

namespace {

/// A line takes some 200 bytes, of a frame with every intermediate 1 KiB. Of a larger file the
/// first of them count.
constexpr uint64_t kMaxJournalBytes = uint64_t{1} << 28;
/// Far above a frame's picture and its intermediates.
constexpr size_t kMaxFilesPerFrame = 64;
constexpr std::string_view kJournalName = "shutter frames 1";
/// File systems take 255.
constexpr size_t kMaxNameBytes = 200;

fs::path folderOf(const fs::path& file) {
    return file.has_parent_path() ? file.parent_path() : fs::path(".");
}

std::string formatHeader(const std::string& fingerprint) {
    nlohmann::ordered_json header;
    header["fingerprint"] = fingerprint;
    header["journal"] = kJournalName;
    return json::formatJsonLine(header);
}

/// Empty where the line is none.
std::string readHeader(std::string_view line) {
    auto document = json::JsonDocument::parse(line, "journal");
    if (!document)
        return {};
    const json::JsonObject header = document.value().root().readObject({"journal", "fingerprint"});
    const std::string name = header.require("journal").readString();
    std::string fingerprint = header.require("fingerprint").readString();
    return document.value().finish() && name == kJournalName ? fingerprint : std::string();
}

/// The lines that end; the rest of a killed run's last one is not among them.
std::vector<std::string_view> splitLines(std::string_view text) {
    std::vector<std::string_view> lines;
    for (size_t end = text.find('\n'); end != std::string_view::npos; end = text.find('\n')) {
        lines.push_back(text.substr(0, end));
        text.remove_prefix(end + 1);
    }
    return lines;
}

core::Status appendLine(const fs::path& file, const std::string& line) {
    const int descriptor = ::open(file.c_str(), O_WRONLY | O_APPEND | O_CLOEXEC);
    // At once: two runs that draw parts of one sequence share the journal.
    const ssize_t written = descriptor < 0 ? -1 : ::write(descriptor, line.data(), line.size());
    const int why = errno;
    if (descriptor >= 0)
        ::close(descriptor);
    if (written == ssize_t(line.size()))
        return {};
    return core::makeError(
        "cannot write '{}': {}",
        file.string(),
        written < 0 ? std::generic_category().message(why) : "the disk is full"
    );
}

} // namespace

fs::path journalFile(const fs::path& pattern) {
    std::string name = pattern.filename().string();
    if (name.size() > kMaxNameBytes)
        name = io::computeContentHash(name);
    return pattern.parent_path() / ("." + name + ".journal");
}

core::Result<SequenceJournal> SequenceJournal::open(fs::path file, const std::string& fingerprint) {
    SequenceJournal journal(std::move(file), Before::Nothing);
    const auto isWhole = journal.readFile(fingerprint);
    if (!isWhole)
        return isWhole.error();
    if (!isWhole.value())
        SHUTTER_TRY(journal.rewrite(fingerprint));
    return journal;
}

core::Result<SequenceJournal> SequenceJournal::read(fs::path file, const std::string& fingerprint) {
    SequenceJournal journal(std::move(file), Before::Nothing);
    if (const auto isWhole = journal.readFile(fingerprint); !isWhole)
        return isWhole.error();
    return journal;
}

core::Result<bool> SequenceJournal::readFile(const std::string& fingerprint) {
    std::error_code ignored;
    if (!fs::is_regular_file(mFile, ignored))
        return false;
    const auto bytes = io::readFileBytes(mFile, kMaxJournalBytes);
    if (!bytes)
        return bytes.error();
    const auto* text = reinterpret_cast<const char*>(bytes.value().data());
    return readLines({text, bytes.value().size()}, fingerprint);
}

bool SequenceJournal::readLines(std::string_view text, const std::string& fingerprint) {
    mBefore = Before::OtherPictures;
    const std::vector<std::string_view> lines = splitLines(text);
    if (lines.empty() || readHeader(lines.front()) != fingerprint)
        return false;
    mBefore = Before::SamePictures;
    bool isWhole = text.ends_with('\n');
    for (size_t i = 1; i < lines.size(); ++i) {
        auto document = json::JsonDocument::parse(lines[i], "journal");
        if (!document) {
            isWhole = false;
            continue;
        }
        const json::JsonObject line = document.value().root().readObject({"frame", "files"});
        const auto frame = int(line.require("frame").readInteger(INT32_MIN, INT32_MAX));
        std::vector<File> files;
        for (const json::JsonNode& node : line.require("files").readArray(1, kMaxFilesPerFrame)) {
            const json::JsonObject file = node.readObject({"name", "hash"});
            const json::JsonNode name = file.require("name");
            files.push_back({name.readString(), file.require("hash").readString()});
            if (!io::liesInside(folderOf(mFile), files.back().name))
                name.fail("leaves the journal's folder");
        }
        if (document.value().finish())
            mFrames[frame] = std::move(files);
        else
            isWhole = false;
    }
    return isWhole;
}

core::Status SequenceJournal::rewrite(const std::string& fingerprint) const {
    std::string text = formatHeader(fingerprint);
    for (const auto& [frame, files] : mFrames)
        text += formatLine(frame, files);
    return io::writeFileText(mFile, text);
}

std::string SequenceJournal::formatLine(int frame, const std::vector<File>& files) {
    nlohmann::ordered_json line;
    nlohmann::ordered_json& list = line["files"] = nlohmann::ordered_json::array();
    for (const File& file : files) {
        nlohmann::ordered_json& entry = list.emplace_back();
        entry["hash"] = file.hash;
        entry["name"] = file.name;
    }
    line["frame"] = frame;
    // A name that is not UTF-8 is replaced, so it is not found later and its frame is drawn again.
    return json::formatJsonLine(line);
}

bool SequenceJournal::isComplete(int frame, const fs::path& picture) const {
    const auto found = mFrames.find(frame);
    if (found == mFrames.end())
        return false;
    const std::vector<File>& files = found->second;
    const std::string own = nameInFolder(picture);
    return std::any_of(
               files.begin(), files.end(), [&](const File& file) { return file.name == own; }
           ) &&
           std::all_of(files.begin(), files.end(), [&](const File& file) {
               const auto hash = io::computeFileHash(folderOf(mFile) / file.name);
               return hash && hash.value() == file.hash;
           });
}

std::string SequenceJournal::nameInFolder(const fs::path& file) const {
    return file.lexically_relative(folderOf(mFile)).string();
}

core::Status SequenceJournal::addFrom(const SequenceJournal& other, int frame) {
    const auto found = other.mFrames.find(frame);
    if (found == other.mFrames.end())
        return {};
    SHUTTER_TRY(appendLine(mFile, formatLine(frame, found->second)));
    mFrames[frame] = found->second;
    return {};
}

core::Status SequenceJournal::add(int frame, const std::vector<fs::path>& files) {
    std::vector<File> complete;
    for (const fs::path& file : files) {
        std::error_code ignored;
        if (fs::exists(file, ignored) && !fs::is_regular_file(file, ignored))
            return {}; // a pipe keeps nothing: the frame is drawn again
        auto hash = io::computeFileHash(file);
        if (!hash)
            return hash.error();
        complete.push_back({nameInFolder(file), std::move(hash).value()});
    }
    SHUTTER_TRY(appendLine(mFile, formatLine(frame, complete)));
    mFrames[frame] = std::move(complete);
    return {};
}

} // namespace shutter::game
