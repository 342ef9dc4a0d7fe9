// Bytes in and out of blobs: little-endian, without padding, checked when read.
#pragma once

#include <bit>
#include <cstdint>
#include <cstring>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>

#include "helicoid/geometry/pose2.hpp"

namespace helicoid::store {

static_assert(std::endian::native == std::endian::little, "blobs are written as they lie in memory: little-endian");

class BlobWriter {
 public:
  void clear() { bytes_.clear(); }
  [[nodiscard]] std::string_view bytes() const { return bytes_; }

  template <class T>
  requires std::is_arithmetic_v<T>
  void put(T value) {
    char raw[sizeof(T)];
    std::memcpy(raw, &value, sizeof(T));
    bytes_.append(raw, sizeof(T));
  }
  template <class T>
  void put_all(std::span<const T> values) {
    if (!values.empty()) bytes_.append(reinterpret_cast<const char*>(values.data()), values.size_bytes());
  }
  void put(const Pose2& pose) {
    put(pose.x);
    put(pose.y);
    put(pose.yaw);
  }
  void put(const std::string& text) {
    put(static_cast<std::uint32_t>(text.size()));
    bytes_.append(text);
  }
  /// A square matrix: its lower triangle if it is symmetric to the bit, else all of it.
  template <class Matrix>
  void put_matrix(const Matrix& m) {
    bool symmetric = true;
    for (int c = 0; c < m.cols(); ++c) {
      for (int r = 0; r < c; ++r) {
        symmetric &= std::bit_cast<std::uint64_t>(m(r, c)) == std::bit_cast<std::uint64_t>(m(c, r));
      }
    }
    put(static_cast<std::uint8_t>(symmetric));
    for (int c = 0; c < m.cols(); ++c) {
      for (int r = symmetric ? c : 0; r < m.rows(); ++r) put(m(r, c));
    }
  }

 private:
  std::string bytes_;
};

/// Reads what BlobWriter wrote. Past the end every read gives zero and `ok()` turns false for good.
class BlobReader {
 public:
  explicit BlobReader(std::string_view bytes) : bytes_(bytes) {}
  /// True while every read was inside the blob.
  [[nodiscard]] bool ok() const { return ok_; }
  /// True if all was read, and no more.
  [[nodiscard]] bool finished() const { return ok_ && bytes_.empty(); }
  [[nodiscard]] std::size_t left() const { return bytes_.size(); }

  template <class T>
  T get() {
    T value{};
    if (!take(sizeof(T))) return value;
    std::memcpy(&value, bytes_.data(), sizeof(T));
    bytes_.remove_prefix(sizeof(T));
    return value;
  }
  Pose2 get_pose() {
    Pose2 pose;
    pose.x = get<double>();
    pose.y = get<double>();
    pose.yaw = get<double>();
    return pose;
  }
  std::string get_text() {
    const auto size = get<std::uint32_t>();
    if (!take(size)) return {};
    std::string text(bytes_.substr(0, size));
    bytes_.remove_prefix(size);
    return text;
  }
  template <class Matrix>
  Matrix get_matrix() {
    Matrix m = Matrix::Zero();
    const bool symmetric = get<std::uint8_t>() != 0;
    for (int c = 0; c < m.cols(); ++c) {
      for (int r = symmetric ? c : 0; r < m.rows(); ++r) {
        m(r, c) = get<double>();
        if (symmetric) m(c, r) = m(r, c);
      }
    }
    return m;
  }

 private:
  bool take(std::size_t size) {
    ok_ = ok_ && bytes_.size() >= size;
    return ok_;
  }
  std::string_view bytes_;
  bool ok_ = true;
};

}  // namespace helicoid::store
