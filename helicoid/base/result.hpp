// Errors at the edges are values: a message that says the thing, the place and the mend.
#pragma once

#include <fmt/format.h>

#include <string>
#include <tl/expected.hpp>
#include <utility>

namespace helicoid {

/// Why something could not be done, in one sentence that a person can act on.
struct Error {
  std::string message;
};

/// A value, or the reason why there is none.
template <class T>
using Result = tl::expected<T, Error>;

/// The failing branch of a Result: `return fail("{}: is a directory; name a log", path);`
template <class... Args>
[[nodiscard]] tl::unexpected<Error> fail(fmt::format_string<Args...> format, Args&&... args) {
  return tl::unexpected<Error>(Error{fmt::format(format, std::forward<Args>(args)...)});
}

}  // namespace helicoid
