// SPDX-License-Identifier: MIT
// How the parts of the glTF loader report a bad file to loadGltf. A file can be wrong in hundreds
// of places, all of them end the load, so this is an exception; it never leaves this folder.
#pragma once

#include <fmt/format.h>

#include <stdexcept>
#include <string>
#include <utility>

namespace shutter::gltf {

/// what() is a sentence without the file's name, e.g. "accessors[3].count must be at least 1".
class GltfError : public std::runtime_error {
  public:
    using std::runtime_error::runtime_error;
};

template <class... Args>
[[noreturn]] void failGltf(fmt::format_string<Args...> format, Args&&... args) {
    throw GltfError(fmt::format(format, std::forward<Args>(args)...));
}

} // namespace shutter::gltf
