// Strong integer names: a PatchId cannot be handed where a RobotId is asked for.
#pragma once

#include <compare>
#include <cstddef>
#include <cstdint>
#include <limits>

namespace helicoid {

/// An index with a type. Ids of one kind are dense: they number 0, 1, 2, ... in order of making.
template <class Tag>
struct Id {
  static constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();

  std::uint32_t value = kNone;

  [[nodiscard]] constexpr bool valid() const { return value != kNone; }
  /// The place of this id's object in a table that holds all objects of the kind.
  [[nodiscard]] constexpr std::size_t index() const { return value; }
  friend constexpr auto operator<=>(const Id&, const Id&) = default;
};

using PatchId = Id<struct PatchTag>;
using RobotId = Id<struct RobotTag>;
using IslandId = Id<struct IslandTag>;
using RelationId = Id<struct RelationTag>;

template <class IdType>
[[nodiscard]] constexpr IdType make_id(std::size_t index) {
  return IdType{static_cast<std::uint32_t>(index)};
}

}  // namespace helicoid
