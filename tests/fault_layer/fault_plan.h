// SPDX-License-Identifier: MIT
#pragma once

#include <vulkan/vulkan_core.h>

#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

namespace shutter::faults {

/// The calls of one kind that fail, counted from 1.
struct FailingCalls {
    uint32_t first = 0; ///< 0: none
    bool andAllLater = false;

    [[nodiscard]] bool holds(uint32_t call) const {
        return first != 0 && (call == first || (andAllLater && call > first));
    }
};

/// The faults requested by environment variables; README.md lists them.
struct FaultPlan {
    FailingCalls allocations;
    std::map<std::string, FailingCalls> creations; ///< by the function's name without "vk"
    std::map<uint32_t, VkResult> swapchains;       ///< by the number of the call that makes one
    uint32_t lostSubmission = 0;                   ///< 0: none; this one is refused
    uint32_t lostExecution = 0;                ///< 0: none; this one is taken and never ends well
    std::map<uint32_t, VkResult> acquisitions; ///< by the number of the call
    std::map<uint32_t, VkResult> presentations;
    std::set<std::string> hidden; ///< extensions and features that are reported as missing
    std::map<std::string, uint32_t> limits;
    std::optional<VkPhysicalDeviceType> kind;       ///< none: the device's own
    std::vector<VkMemoryPropertyFlags> memoryTypes; ///< empty: the device's own
    std::string countsFile;                         ///< empty: none
    uint32_t lastBeforeFiles = 0; ///< submission after whose end files stay below `fileBytes`
    uint32_t fileBytes = 0;
    std::string statisticsFolder; ///< of pipelines that are measured; empty: none
    std::string heldPipeline;     ///< name of shaders; pipelines of these wait; empty: none
    std::string heldUntil;        ///< FIFO that a test opens for writing

    /// Whether the `number`th call of a function that makes something fails.
    [[nodiscard]] bool failsCreation(const std::string& name, uint32_t number) const {
        const auto failing = creations.find(name);
        return failing != creations.end() && failing->second.holds(number);
    }

    /// What reread() read last.
    [[nodiscard]] static const FaultPlan& get();

    /// For a new instance. Invalid values end the process: a test without faults would pass.
    static void reread();
};

/// Prints a sentence and ends the process.
[[noreturn]] void refuse(const std::string& sentence);

} // namespace shutter::faults
