// sketch.svg: the sketch map as a drawing that stays sharp at any size.
#pragma once

#include <optional>
#include <span>
#include <string>

#include "helicoid/base/result.hpp"
#include "helicoid/charts/sketch.hpp"
#include "helicoid/charts/topology.hpp"
#include "helicoid/charts/way.hpp"

namespace helicoid {

/// One island or one sheet of the drawing; each gets a floor colour of its own, later ones are drawn above.
struct SketchLayer {
  std::string name;  ///< such as "sheet 0"; becomes the group's id
  Sketch sketch;
};

struct SketchDrawing {
  std::vector<SketchLayer> layers;
  std::vector<Way> ways;
  std::optional<Topology> topology;  ///< drawn above the floor if given
  std::string title;
};

/// A complete SVG 1.1 document; user units are centimetres of the island's plane, y upwards inside the drawing.
[[nodiscard]] std::string to_svg(const SketchDrawing& drawing);
[[nodiscard]] Result<void> write_sketch(const SketchDrawing& drawing, const std::string& path);

}  // namespace helicoid
