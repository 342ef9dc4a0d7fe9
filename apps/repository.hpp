// The source tree that the program is run in, if it is: experiments store their pages there.
#pragma once

#include <string>

namespace helicoid {

/// The tree above the working directory; empty if there is none.
[[nodiscard]] std::string find_repository();
/// Recorded logs beside the source tree (../shared/data); empty if there are none.
[[nodiscard]] std::string find_recorded_data();

}  // namespace helicoid
