// The materials of a panel: surfaces, overlays, obstacles.

#include "testbed/view/panel/actors.h"

#include <vtkActor.h>
#include <vtkLookupTable.h>
#include <vtkNew.h>
#include <vtkPolyData.h>
#include <vtkPolyDataMapper.h>
#include <vtkProperty.h>
#include <vtkSmartPointer.h>

#include <algorithm>
#include <array>

#include "testbed/view/panel/drawable.h"
#include "testbed/view/panel/water.h"

namespace geoprior {
namespace {

using Color = std::array<double, 3>;

// Matt clay, close to skin: neutral enough that shading alone shows the shape.
constexpr Color kClayColor{0.86, 0.72, 0.63};
// Office paper, and its other side a little darker and cooler, so that a fold shows which is up.
// A surface coloured by an array has the same colours on both sides.
constexpr Color kPaperColor{0.93, 0.915, 0.87};
constexpr Color kPaperBack{0.86, 0.88, 0.92};
constexpr Color kLineColor{0.16, 0.27, 0.45};
constexpr Color kEdgeColor{0.47, 0.48, 0.51};
constexpr Color kObstacleColor{0.55, 0.60, 0.66};

constexpr const char* kBevel = "bevel";

// Parts of the window's size.
constexpr double kThickness = 0.008;          ///< of lines and points that are the part itself
constexpr double kOverlayThickness = 0.0027;  ///< of lines over it
constexpr double kFineThickness = 0.0008;     ///< of those that are fine
constexpr double kOverlayRadius = 0.012;      ///< of points over it
constexpr double kLift = 0.002;               ///< of overlays, towards the eye

vtkSmartPointer<vtkLookupTable> to_lookup_table(const ColorScale& scale) {
  auto table = vtkSmartPointer<vtkLookupTable>::New();
  constexpr int kColors = 256;
  const bool numbers = scale.palette.empty();
  const int count = numbers ? kColors : static_cast<int>(scale.palette.size());
  table->SetNumberOfTableValues(count);
  table->SetRange(scale.low, scale.high);
  for (int i = 0; i < count; ++i) {
    const Color color = numbers ? color_at(i / (kColors - 1.0), scale.diverging) : scale.palette[i];
    table->SetTableValue(i, color[0], color[1], color[2]);
  }
  table->SetNanColor(0.6, 0.6, 0.6, 1);
  table->Build();
  return table;
}

void set_color(vtkProperty* material, const Color& color) {
  material->SetColor(color[0], color[1], color[2]);
}

vtkSmartPointer<vtkActor> plain_actor(const Part& part, const std::string& color_by,
                                      double thickness, bool flat) {
  vtkNew<vtkPolyDataMapper> mapper;
  mapper->SetInputData(to_drawable(part, color_by, thickness, flat));
  mapper->ScalarVisibilityOff();
  auto actor = vtkSmartPointer<vtkActor>::New();
  actor->SetMapper(mapper);
  return actor;
}

void apply(const ColorScale& scale, vtkActor* actor) {
  auto* mapper = vtkPolyDataMapper::SafeDownCast(actor->GetMapper());
  mapper->ScalarVisibilityOn();
  mapper->SetLookupTable(to_lookup_table(scale));
  mapper->UseLookupTableScalarRangeOn();
  mapper->SetInterpolateScalarsBeforeMapping(scale.palette.empty() ? 1 : 0);
}

void set_material(const PanelStyle& style, bool colored, bool thin, vtkActor* actor) {
  vtkProperty* material = actor->GetProperty();
  const bool paper = style.material == PanelStyle::Material::paper;
  set_color(material, thin ? kLineColor : paper ? kPaperColor : kClayColor);
  material->SetAmbient(style.raking ? 0.02 : paper ? 0.30 : colored ? 0.26 : 0.22);
  material->SetDiffuse(style.raking ? 0.98 : colored ? 0.70 : paper ? 0.68 : 0.82);
  material->SetSpecular(paper ? 0.03 : colored ? 0.05 : 0.14);
  material->SetSpecularPower(22);
  if (style.flat && !thin) {
    material->SetInterpolationToFlat();
  } else {
    material->SetInterpolationToPhong();
  }
  if (paper && !thin) {
    vtkNew<vtkProperty> back;
    back->DeepCopy(material);
    set_color(back, kPaperBack);
    actor->SetBackfaceProperty(back);
  }
}

void show_edges(int pixels_per_pixel, vtkActor* actor) {
  vtkProperty* material = actor->GetProperty();
  material->EdgeVisibilityOn();
  material->SetEdgeColor(kEdgeColor[0], kEdgeColor[1], kEdgeColor[2]);
  material->SetLineWidth(static_cast<float>(0.7 * pixels_per_pixel));
}

vtkSmartPointer<vtkActor> main_actor(const Part& part, const ViewWindow& window,
                                     const PanelStyle& style, int pixels_per_pixel) {
  const bool colored = style.scale && part.find_array(style.scale->array) != nullptr;
  const bool surface = part.kind == Part::Kind::triangles;
  auto actor = plain_actor(part, colored ? style.scale->array : "", kThickness * window.height_m,
                           style.flat && surface);
  if (colored) apply(*style.scale, actor);
  const bool thin = part.kind == Part::Kind::lines || part.kind == Part::Kind::points;
  set_material(style, colored, thin, actor);
  // A map is no shape: its colours are those of the bar.
  if (colored && part.kind == Part::Kind::grid) actor->GetProperty()->LightingOff();
  if (style.material == PanelStyle::Material::water && surface) {
    const bool has_ground = colored && !style.scale->palette.empty();
    const WaterTint tint = has_ground ? WaterTint::but_ground
                           : colored  ? WaterTint::all
                                      : WaterTint::none;
    shade_as_water(actor, window, tint, has_ground ? style.scale->palette.front() : Color{});
  }
  if (style.edges && surface) show_edges(pixels_per_pixel, actor);
  return actor;
}

/// A solid thing beside the part (a hull): painted, lit as clay is.
void set_solid_material(vtkProperty* material) {
  material->SetInterpolationToFlat();
  material->SetAmbient(0.30);
  material->SetDiffuse(0.75);
  material->SetSpecular(0.12);
  material->SetSpecularPower(22);
}

/// The window's size that lines and balls over a part are drawn by.
double overlay_size(const ViewWindow& window) {
  return std::max(window.height_m, 0.7 * window.width_m);
}

/// The colour of the overlay, and most of the way to white where it is cut away.
ColorScale bevel_scale(const Color& color) {
  Color light = color;
  for (double& channel : light) channel = (channel + 3) / 4;
  ColorScale scale;
  scale.array = kBevel;
  scale.palette = {color, light};
  return scale;
}

vtkSmartPointer<vtkActor> overlay_actor(const PanelOverlay& overlay, const ViewWindow& window) {
  const bool points = overlay.part->kind == Part::Kind::points;
  const double size = overlay_size(window);
  const double thickness = size * (overlay.fine ? kFineThickness : kOverlayThickness);
  const bool bevelled = overlay.part->find_array(kBevel) != nullptr;
  auto actor = plain_actor(*overlay.part, bevelled ? kBevel : "",
                           points ? overlay_ball_radius(window) : thickness, bevelled);
  const Eigen::Vector3d lift = kLift * size * window.direction;
  actor->SetPosition(lift.x(), lift.y(), lift.z());
  vtkProperty* material = actor->GetProperty();
  set_color(material, overlay.color);
  material->SetAmbient(points ? 0.35 : 0.6);
  material->SetDiffuse(points ? 0.75 : 0.4);
  material->SetSpecular(points ? 0.25 : 0.0);
  material->SetSpecularPower(30);
  if (bevelled) {
    apply(bevel_scale(overlay.color), actor);  // narrow: lit by its surroundings
  } else if (overlay.part->kind == Part::Kind::triangles) {
    set_solid_material(material);
  }
  return actor;
}

vtkSmartPointer<vtkActor> obstacle_actor(const Part& part, const ViewWindow& window) {
  auto actor = plain_actor(part, "", kThickness * window.height_m, true);
  vtkProperty* material = actor->GetProperty();
  set_color(material, kObstacleColor);
  material->SetInterpolationToFlat();
  material->SetAmbient(0.5);
  material->SetDiffuse(0.5);
  material->SetOpacity(0.18);
  return actor;
}

}  // namespace

double overlay_ball_radius(const ViewWindow& window) {
  return kOverlayRadius * overlay_size(window);
}

PanelActors make_actors(const PanelParts& parts, const ViewWindow& window, const PanelStyle& style,
                        int pixels_per_pixel) {
  PanelActors actors;
  for (const Part* part : parts.parts) {
    actors.opaque.push_back(main_actor(*part, window, style, pixels_per_pixel));
  }
  for (const PanelOverlay& overlay : parts.overlays) {
    actors.opaque.push_back(overlay_actor(overlay, window));
  }
  for (const Part* part : parts.obstacles) actors.faint.push_back(obstacle_actor(*part, window));
  return actors;
}

}  // namespace geoprior
