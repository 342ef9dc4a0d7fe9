// map.png: the picture of a map for people.
#pragma once

#include <span>
#include <string>

#include "helicoid/base/result.hpp"
#include "helicoid/charts/sheet_charts.hpp"
#include "helicoid/charts/way.hpp"

namespace helicoid {

struct PictureOptions {
  int longest_side = 2000;  ///< of the map's part, pixels; a cell gets a whole number of them, at least 1, at most 8
  int sheets = 0;           ///< the number that the caption gives (Sheets::count); 0: the deepest stack of drawn cells
  std::string title;        ///< such as "intel" or "island 2 of 3"; may be empty
};

/// Walls on free space on a calm ground, robots' ways, a scale bar and a legend; where sheets lie over one another the
/// floor is hatched and a line of text says so. Errors: the place cannot be written, the picture is too large.
[[nodiscard]] Result<void> write_picture(const SheetStack& sheets, std::span<const Way> ways, const std::string& path,
                                         const PictureOptions& options = {});

}  // namespace helicoid
