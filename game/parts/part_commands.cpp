// SPDX-License-Identifier: MIT
#include "game/parts/part_commands.h"

#include "game/options/program.h"

#include <CLI/CLI.hpp>

#include <algorithm>
#include <memory>
#include <utility>

namespace shutter::parts {

namespace {

using Arguments = std::shared_ptr<PartArguments>;

CLI::App& addHiddenCommand(
    CLI::App& app,
    const char* name,
    const std::string& help,
    int& exitStatus,
    const Arguments& arguments,
    core::Status (*run)(const PartArguments&)
) {
    CLI::App* command = app.add_subcommand(name, help);
    command->group("");
    command->add_option("folder", arguments->folder, "working folder")->required();
    command->callback([arguments, run, &exitStatus] {
        const core::Status done = run(*arguments);
        exitStatus = done ? game::kExitDone : game::fail(game::kExitFailed, done.error());
    });
    return *command;
}

} // namespace

void addPartCommands(CLI::App& app, int& exitStatus, const PartCommands& commands) {
    const auto part = std::make_shared<PartArguments>();
    CLI::App& one = addHiddenCommand(
        app,
        commands.part,
        fmt::format("do a part of a planned {}", commands.noun),
        exitStatus,
        part,
        commands.doPart
    );
    one.add_option("part", part->part, "index of the part")->required();
    one.add_option("--device", part->device, "in place of the one that was planned");
    addHiddenCommand(
        app,
        commands.finish,
        fmt::format("finish a {} whose parts are done", commands.noun),
        exitStatus,
        std::make_shared<PartArguments>(),
        commands.doFinish
    );
}

core::Status checkPart(uint32_t part, size_t partCount, const std::string& noun) {
    if (part < partCount)
        return {};
    return core::makeError(
        "part {} is none of the {}'s: it has parts 0 to {}", part, noun, partCount - 1
    );
}

std::vector<std::string> listTypedWords(
    std::span<const CLI::Option* const> options, std::span<const std::string_view> left
) {
    std::vector<std::string> words;
    std::vector<std::string> places; // in front: an option of many values would take them
    for (const CLI::Option* option : options) {
        const std::string name = option->get_name();
        if (option->count() == 0 || std::find(left.begin(), left.end(), name) != left.end())
            continue;
        const bool isFlag = option->get_items_expected_max() == 0;
        for (const std::string& value : option->results()) {
            if (option->get_lnames().empty()) {
                places.push_back(value);
                continue;
            }
            words.push_back(name);
            if (!isFlag)
                words.push_back(value);
        }
    }
    places.insert(places.end(), words.begin(), words.end());
    return places;
}

core::Status parseWords(CLI::App& command, std::span<const std::string> words) {
    std::vector<std::string> reversed(words.rbegin(), words.rend()); // as CLI11 takes them
    try {
        command.parse(std::move(reversed));
    } catch (const CLI::ParseError& error) {
        return core::Error{error.what()};
    }
    return {};
}

} // namespace shutter::parts
