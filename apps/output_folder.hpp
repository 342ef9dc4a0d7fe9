// The folder that a verb writes into.
#pragma once

#include <string>

#include "helicoid/base/result.hpp"

namespace helicoid {

/// Makes the folder. A folder that holds something and was not made by Helicoid (it has no `mark` file) is refused
/// unless `force`; what Helicoid made before is cleared away.
[[nodiscard]] Result<void> prepare_output_folder(const std::string& folder, const std::string& mark, bool force);

}  // namespace helicoid
