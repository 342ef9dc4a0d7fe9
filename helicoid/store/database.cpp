#include "helicoid/store/database.hpp"

#include <sqlite3.h>

namespace helicoid::store {

Database::Database(const std::string& path, Mode mode) {
  const int flags = mode == Mode::create ? SQLITE_OPEN_READWRITE | SQLITE_OPEN_CREATE : SQLITE_OPEN_READONLY;
  note(sqlite3_open_v2(path.c_str(), &connection_, flags | SQLITE_OPEN_NOMUTEX, nullptr));
}

Database::~Database() {
  sqlite3_close_v2(connection_);
}

void Database::note(int code) {
  if (error_ || code == SQLITE_OK || code == SQLITE_ROW || code == SQLITE_DONE) return;
  error_ = connection_ != nullptr ? sqlite3_errmsg(connection_) : sqlite3_errstr(code);
}

void Database::run(const std::string& sql) {
  if (!error_) note(sqlite3_exec(connection_, sql.c_str(), nullptr, nullptr, nullptr));
}

void Database::close() {
  if (!error_) note(sqlite3_close(connection_));
  if (!error_) connection_ = nullptr;
}

Statement::Statement(Database& database, std::string_view sql) : database_(database) {
  if (database.error_) return;
  database.note(
      sqlite3_prepare_v2(database.connection_, sql.data(), static_cast<int>(sql.size()), &statement_, nullptr));
}

Statement::~Statement() {
  sqlite3_finalize(statement_);
}

Statement& Statement::bind(int at, std::int64_t value) {
  if (!database_.error_) database_.note(sqlite3_bind_int64(statement_, at + 1, value));
  return *this;
}

Statement& Statement::bind(int at, double value) {
  if (!database_.error_) database_.note(sqlite3_bind_double(statement_, at + 1, value));
  return *this;
}

Statement& Statement::bind(int at, std::string_view text) {
  if (!database_.error_) {
    database_.note(sqlite3_bind_text(statement_, at + 1, text.data(), static_cast<int>(text.size()), SQLITE_STATIC));
  }
  return *this;
}

Statement& Statement::bind_blob(int at, std::string_view bytes) {
  if (!database_.error_) {
    database_.note(sqlite3_bind_blob64(statement_, at + 1, bytes.data(), bytes.size(), SQLITE_STATIC));
  }
  return *this;
}

bool Statement::step() {
  if (database_.error_) return false;
  const int code = sqlite3_step(statement_);
  database_.note(code);
  return code == SQLITE_ROW;
}

void Statement::execute() {
  while (step()) {
  }
  // The outcome was noted by step.
  if (statement_ != nullptr) sqlite3_reset(statement_);
}

std::int64_t Statement::integer(int column) const {
  return sqlite3_column_int64(statement_, column);
}

std::string_view Statement::blob(int column) const {
  const auto* bytes = static_cast<const char*>(sqlite3_column_blob(statement_, column));
  return {bytes, static_cast<std::size_t>(sqlite3_column_bytes(statement_, column))};
}

std::string Statement::text(int column) const {
  return std::string(blob(column));
}

}  // namespace helicoid::store
