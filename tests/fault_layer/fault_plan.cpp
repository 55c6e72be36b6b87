// SPDX-License-Identifier: MIT
#include "tests/fault_layer/fault_plan.h"

#include "tests/fault_layer/dispatch.h"

#include <algorithm>
#include <charconv>
#include <cstdio>
#include <cstdlib>
#include <string_view>
#include <system_error>
#include <tuple>
#include <utility>

namespace shutter::faults {

namespace {

std::string readVariable(const char* name) {
    const char* value = std::getenv(name);
    return value ? value : "";
}

std::vector<std::string> split(const std::string& text, char separator) {
    std::vector<std::string> parts;
    for (size_t begin = 0; begin < text.size();) {
        const size_t end = std::min(text.find(separator, begin), text.size());
        parts.push_back(text.substr(begin, end - begin));
        begin = end + 1;
    }
    return parts;
}

uint32_t readNumber(const std::string& text) {
    uint32_t number = 0;
    const char* const end = text.data() + text.size();
    const auto read = std::from_chars(text.data(), end, number);
    if (text.empty() || read.ec != std::errc() || read.ptr != end)
        refuse("'" + text + "' is not a number");
    return number;
}

/// NAME=VALUE
std::pair<std::string, std::string> readPair(const std::string& text) {
    const size_t at = text.find('=');
    if (at == std::string::npos)
        refuse("'" + text + "' has no '='");
    return {text.substr(0, at), text.substr(at + 1)};
}

FailingCalls readCalls(std::string text) {
    FailingCalls calls;
    if (text.empty())
        return calls;
    if (text.back() == '+') {
        calls.andAllLater = true;
        text.pop_back();
    }
    calls.first = readNumber(text);
    return calls;
}

VkResult readWindowResult(const std::string& word) {
    if (word == "SUBOPTIMAL")
        return VK_SUBOPTIMAL_KHR;
    if (word == "OUT_OF_DATE")
        return VK_ERROR_OUT_OF_DATE_KHR;
    if (word == "SURFACE_LOST")
        return VK_ERROR_SURFACE_LOST_KHR;
    refuse("'" + word + "' is no answer of a window");
}

std::map<std::string, FailingCalls> readCreations(const std::string& text) {
    std::map<std::string, FailingCalls> creations;
    for (const std::string& part : split(text, ',')) {
        const auto [name, calls] = readPair(part);
        const auto names = listCreationNames();
        const auto others = listOtherCreationNames();
        if (std::find(others.begin(), others.end(), name) == others.end() &&
            std::find(names.begin(), names.end(), name) == names.end())
            refuse("'" + name + "' makes nothing");
        creations[name] = readCalls(calls);
    }
    return creations;
}

std::map<uint32_t, VkResult> readWindowResults(const std::string& text) {
    std::map<uint32_t, VkResult> results;
    for (const std::string& part : split(text, ',')) {
        const auto [call, word] = readPair(part);
        results[readNumber(call)] = readWindowResult(word);
    }
    return results;
}

VkMemoryPropertyFlags readMemoryType(const std::string& text) {
    VkMemoryPropertyFlags flags = 0;
    for (const std::string& word : split(text, '+')) {
        if (word == "local")
            flags |= VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT;
        else if (word == "visible")
            flags |= VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT;
        else if (word == "coherent")
            flags |= VK_MEMORY_PROPERTY_HOST_COHERENT_BIT;
        else if (word == "cached")
            flags |= VK_MEMORY_PROPERTY_HOST_CACHED_BIT;
        else
            refuse("'" + word + "' is no property of memory");
    }
    return flags;
}

FaultPlan readPlan() {
    FaultPlan plan;
    plan.allocations = readCalls(readVariable("SHUTTER_FAULT_ALLOCATION"));
    plan.creations = readCreations(readVariable("SHUTTER_FAULT_CREATION"));
    if (const std::string text = readVariable("SHUTTER_FAULT_SUBMISSION"); !text.empty())
        plan.lostSubmission = readNumber(text);
    if (const std::string text = readVariable("SHUTTER_FAULT_EXECUTION"); !text.empty())
        plan.lostExecution = readNumber(text);
    plan.swapchains = readWindowResults(readVariable("SHUTTER_FAULT_SWAPCHAIN"));
    plan.acquisitions = readWindowResults(readVariable("SHUTTER_FAULT_ACQUIRE"));
    plan.presentations = readWindowResults(readVariable("SHUTTER_FAULT_PRESENT"));
    for (const std::string& name : split(readVariable("SHUTTER_FAULT_HIDE"), ','))
        plan.hidden.insert(name);
    for (const std::string& part : split(readVariable("SHUTTER_FAULT_LIMITS"), ',')) {
        const auto [name, value] = readPair(part);
        plan.limits[name] = readNumber(value);
    }
    if (const std::string text = readVariable("SHUTTER_FAULT_KIND"); text == "discrete")
        plan.kind = VK_PHYSICAL_DEVICE_TYPE_DISCRETE_GPU;
    else if (!text.empty())
        refuse("'" + text + "' is no kind of device");
    for (const std::string& type : split(readVariable("SHUTTER_FAULT_MEMORY"), ','))
        plan.memoryTypes.push_back(readMemoryType(type));
    if (plan.memoryTypes.size() > VK_MAX_MEMORY_TYPES)
        refuse("there are too many types of memory");
    if (const std::string text = readVariable("SHUTTER_FAULT_FILES"); !text.empty()) {
        const auto [submission, bytes] = readPair(text);
        plan.lastBeforeFiles = readNumber(submission);
        plan.fileBytes = readNumber(bytes);
    }
    plan.countsFile = readVariable("SHUTTER_FAULT_COUNTS");
    plan.statisticsFolder = readVariable("SHUTTER_FAULT_STATISTICS");
    if (const std::string text = readVariable("SHUTTER_FAULT_HOLD"); !text.empty())
        std::tie(plan.heldPipeline, plan.heldUntil) = readPair(text);
    return plan;
}

FaultPlan sPlan;

} // namespace

void refuse(const std::string& sentence) {
    std::fprintf(stderr, "fault layer: %s\n", sentence.c_str());
    std::_Exit(99);
}

const FaultPlan& FaultPlan::get() {
    return sPlan;
}

void FaultPlan::reread() {
    sPlan = readPlan();
}

} // namespace shutter::faults
