// SPDX-License-Identifier: MIT
// How functions report outcomes that a person may read. Result and Status: a value, or one sentence
// that names the file, field or option at fault (bad files, devices, formats; programming errors
// are CHECKs, check.h). Decision: whether work runs, and why.
#pragma once

#include "engine/core/check.h"

#include <fmt/format.h>

#include <string>
#include <utility>
#include <variant>

namespace shutter::core {

/// One clear sentence for the person at the terminal; no trailing full stop or newline.
struct Error {
    std::string message;
};

template <class... Args>
[[nodiscard]] Error makeError(fmt::format_string<Args...> format, Args&&... args) {
    return Error{fmt::format(format, std::forward<Args>(args)...)};
}

/// A value of type T, or an Error. Test `ok()` (or bool) first: value() of an error and error() of
/// a value are CHECK failures.
template <class T> class [[nodiscard]] Result {
  public:
    Result(T value) : mState(std::in_place_index<0>, std::move(value)) {}

    Result(Error error) : mState(std::in_place_index<1>, std::move(error)) {}

    [[nodiscard]] bool ok() const { return mState.index() == 0; }

    explicit operator bool() const { return ok(); }

    [[nodiscard]] T& value() & {
        checkOk();
        return *std::get_if<0>(&mState);
    }

    [[nodiscard]] const T& value() const& {
        checkOk();
        return *std::get_if<0>(&mState);
    }

    [[nodiscard]] T&& value() && {
        checkOk();
        return std::move(*std::get_if<0>(&mState));
    }

    [[nodiscard]] const Error& error() const {
        SHUTTER_CHECK(!ok(), "error() of a result that has a value");
        return *std::get_if<1>(&mState);
    }

  private:
    void checkOk() const {
        SHUTTER_CHECK(ok(), "value() of an error: {}", std::get_if<1>(&mState)->message);
    }

    std::variant<T, Error> mState;
};

/// Success without a value, or an Error. error() of a success is a CHECK failure.
class [[nodiscard]] Status {
  public:
    Status() = default;

    Status(Error error) : mError(std::move(error)), mOk(false) {}

    [[nodiscard]] bool ok() const { return mOk; }

    explicit operator bool() const { return mOk; }

    [[nodiscard]] const Error& error() const {
        SHUTTER_CHECK(!mOk, "error() of a success");
        return mError;
    }

  private:
    Error mError;
    bool mOk = true;
};

/// Whether something runs, and why.
struct Decision {
    bool run = false;
    std::string reason; ///< for a person; continues "because"
};

/// "ran: ..." or "skipped: ...".
[[nodiscard]] inline std::string describe(const Decision& decision) {
    return (decision.run ? "ran: " : "skipped: ") + decision.reason;
}

} // namespace shutter::core

/// Hands an Error on: returns it from the function, whose type is Status or any Result.
#define SHUTTER_TRY(...)                                                                           \
    do {                                                                                           \
        if (auto shutterTried = (__VA_ARGS__); !shutterTried) [[unlikely]]                         \
            return shutterTried.error();                                                           \
    } while (false)
