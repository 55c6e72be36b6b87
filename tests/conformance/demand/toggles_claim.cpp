// SPDX-License-Identifier: MIT
#include "tests/conformance/demand/claim.h"
#include "tests/conformance/demand/toggle_law.h"

namespace shutter::demand {

namespace {

/// On a device with validation of its own where the layers are installed: what they say counts.
core::Result<Findings> measureTogglesClaim(gpu::Device& device, const DemandOptions&) {
    gpu::DeviceOptions wish;
    wish.wanted = device.info().name;
    wish.bestTier = device.info().rayTier;
    wish.validate = true;
    auto validated = gpu::Device::create(wish);
    gpu::Device& drawing = validated ? *validated.value() : device;
    auto rows = measureToggles(drawing);
    if (!rows)
        return rows.error();
    Findings findings{std::move(rows).value(), {}};
    if (validated)
        findings.checks.push_back(
            {"validation messages",
             double(drawing.validationMessageCount()),
             0.0,
             "",
             ToggleOptions{}.frames}
        );
    return findings;
}

} // namespace

Claim makeTogglesClaim() {
    return {
        "Toggles",
        "Switching leaves nothing behind",
        "2,000 frames of 48x32, each by another method than the one before, with exposure, tone "
        "map and intermediates switched at random, against runs that switch nothing.",
        measureTogglesClaim};
}

} // namespace shutter::demand
