// SPDX-License-Identifier: MIT
#pragma once

#include <fmt/format.h>

#include <compare>
#include <cstddef>
#include <cstdint>
#include <functional>

namespace shutter::ecs {

/// A handle to an entity of one Registry. Indices are reused, generations are not: a stale handle
/// never equals the handle of the entity that reuses its index.
struct Entity {
    uint32_t index = 0xFFFFFFFFu; ///< slot of the registry; all ones in the null entity
    uint32_t generation = 0;      ///< how many entities had this slot before

    [[nodiscard]] friend constexpr auto operator<=>(const Entity&, const Entity&) = default;
};

/// Refers to no entity; never alive in any registry. The value of a default Entity.
inline constexpr Entity kNullEntity{};

} // namespace shutter::ecs

template <> struct std::hash<shutter::ecs::Entity> {
    [[nodiscard]] size_t operator()(const shutter::ecs::Entity& entity) const noexcept {
        const uint64_t bits = (uint64_t{entity.generation} << 32u) | entity.index;
        return std::hash<uint64_t>{}(bits);
    }
};

template <> struct fmt::formatter<shutter::ecs::Entity> {
    constexpr auto parse(fmt::format_parse_context& context) { return context.begin(); }

    template <class Context>
    auto format(const shutter::ecs::Entity& entity, Context& context) const {
        if (entity == shutter::ecs::kNullEntity)
            return fmt::format_to(context.out(), "the null entity");
        return fmt::format_to(
            context.out(), "entity {} (generation {})", entity.index, entity.generation
        );
    }
};
