// A thin owner of an SQLite connection. Errors stick: the first one is kept and everything after it does nothing.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "helicoid/base/result.hpp"

struct sqlite3;
struct sqlite3_stmt;

namespace helicoid::store {

class Database {
 public:
  enum class Mode { create, read };
  Database(const std::string& path, Mode mode);
  ~Database();
  Database(const Database&) = delete;
  Database& operator=(const Database&) = delete;

  /// Runs statements that give no rows.
  void run(const std::string& sql);
  /// Closes the connection, so that all is written; errors stick as everywhere.
  void close();
  /// The first thing that went wrong, in SQLite's words; empty if nothing did.
  [[nodiscard]] const std::optional<std::string>& error() const { return error_; }

 private:
  friend class Statement;
  void note(int code);
  sqlite3* connection_ = nullptr;
  std::optional<std::string> error_;
};

/// A prepared statement. Columns and parameters count from 0.
class Statement {
 public:
  Statement(Database& database, std::string_view sql);
  ~Statement();
  Statement(const Statement&) = delete;
  Statement& operator=(const Statement&) = delete;

  /// The bytes of texts and blobs must live until the next step.
  Statement& bind(int at, std::int64_t value);
  Statement& bind(int at, double value);
  Statement& bind(int at, std::string_view text);
  Statement& bind_blob(int at, std::string_view bytes);
  /// Goes to the next row; false when there is none (or an error).
  bool step();
  /// Runs to the end and makes the statement ready for other values.
  void execute();

  [[nodiscard]] std::int64_t integer(int column) const;
  /// Valid until the next step.
  [[nodiscard]] std::string_view blob(int column) const;
  [[nodiscard]] std::string text(int column) const;

 private:
  Database& database_;
  sqlite3_stmt* statement_ = nullptr;
};

}  // namespace helicoid::store
