// SPDX-License-Identifier: MIT
// What a test expects of a core::Result or core::Status: its value, or a sentence.
#pragma once

#include "engine/core/result.h"

#include <gtest/gtest.h>

#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>

namespace shutter::test {

/// Ends the test with the error's sentence where there is no value.
template <class T> [[nodiscard]] T valueOf(core::Result<T> result) {
    if (!result.ok())
        throw std::runtime_error(result.error().message);
    return std::move(result).value();
}

/// The error's sentence, or "" where there is none.
template <class Outcome> [[nodiscard]] std::string errorOf(const Outcome& outcome) {
    return outcome.ok() ? std::string() : outcome.error().message;
}

/// Expects an error whose sentence holds `part`.
template <class Outcome> void expectRefused(const Outcome& outcome, std::string_view part) {
    ASSERT_FALSE(outcome.ok()) << "accepted; the sentence would hold: " << part;
    EXPECT_NE(outcome.error().message.find(part), std::string::npos)
        << outcome.error().message << "\nlacks: " << part;
}

/// Expects success without a value.
inline void expectDone(const core::Status& status) {
    EXPECT_TRUE(status.ok()) << errorOf(status);
}

} // namespace shutter::test
