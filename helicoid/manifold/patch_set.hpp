// Sets of patches as bits: unions and intersections of neighbourhoods, word by word.
#pragma once

#include <algorithm>
#include <bit>
#include <cstdint>
#include <vector>

namespace helicoid {

/// A set of numbers 0..size-1.
class PatchSet {
 public:
  explicit PatchSet(std::size_t size = 0) : words_((size + 63) / 64, 0) {}

  void insert(std::size_t i) { words_[i / 64] |= std::uint64_t{1} << (i % 64); }
  void erase(std::size_t i) { words_[i / 64] &= ~(std::uint64_t{1} << (i % 64)); }
  [[nodiscard]] bool contains(std::size_t i) const { return (words_[i / 64] >> (i % 64) & 1U) != 0; }
  void clear() { std::fill(words_.begin(), words_.end(), 0); }
  PatchSet& operator|=(const PatchSet& other) {
    for (std::size_t w = 0; w < words_.size(); ++w) words_[w] |= other.words_[w];
    return *this;
  }
  PatchSet& operator&=(const PatchSet& other) {
    for (std::size_t w = 0; w < words_.size(); ++w) words_[w] &= other.words_[w];
    return *this;
  }
  /// Takes the members of `other` out.
  PatchSet& operator-=(const PatchSet& other) {
    for (std::size_t w = 0; w < words_.size(); ++w) words_[w] &= ~other.words_[w];
    return *this;
  }
  /// The least member; the set must not be empty.
  [[nodiscard]] std::size_t first() const {
    std::size_t w = 0;
    while (words_[w] == 0) ++w;
    return 64 * w + static_cast<std::size_t>(std::countr_zero(words_[w]));
  }
  [[nodiscard]] bool intersects(const PatchSet& other) const {
    for (std::size_t w = 0; w < words_.size(); ++w) {
      if ((words_[w] & other.words_[w]) != 0) return true;
    }
    return false;
  }
  /// Calls f with each member, ascending.
  template <class F>
  void for_each(F&& f) const {
    for (std::size_t w = 0; w < words_.size(); ++w) {
      for (std::uint64_t rest = words_[w]; rest != 0; rest &= rest - 1) {
        f(64 * w + static_cast<std::size_t>(std::countr_zero(rest)));
      }
    }
  }
  /// Takes out the members that are in `other`, too, and calls f with each, ascending.
  template <class F>
  void take_common(const PatchSet& other, F&& f) {
    for (std::size_t w = 0; w < words_.size(); ++w) {
      const std::uint64_t common = words_[w] & other.words_[w];
      if (common == 0) continue;
      words_[w] ^= common;
      for (std::uint64_t rest = common; rest != 0; rest &= rest - 1) {
        f(64 * w + static_cast<std::size_t>(std::countr_zero(rest)));
      }
    }
  }
  friend bool operator==(const PatchSet&, const PatchSet&) = default;

 private:
  std::vector<std::uint64_t> words_;
};

}  // namespace helicoid
