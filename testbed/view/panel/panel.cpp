#include "testbed/view/panel/panel.h"

#include <vtkActor.h>
#include <vtkCamera.h>
#include <vtkLight.h>
#include <vtkNew.h>
#include <vtkOpenGLRenderer.h>
#include <vtkPolyData.h>
#include <vtkPolyDataMapper.h>
#include <vtkProperty.h>
#include <vtkRenderStepsPass.h>
#include <vtkRenderWindow.h>
#include <vtkSSAOPass.h>
#include <vtkSmartPointer.h>
#include <vtkUnsignedCharArray.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdlib>

#include "core/error.h"
#include "testbed/view/panel/actors.h"

namespace geoprior {
namespace {

/// Position in camera coordinates: x to the right, y up, z towards the eye.
void add_light(vtkRenderer* renderer, const std::array<double, 3>& from, double intensity,
               const std::array<double, 3>& color) {
  vtkNew<vtkLight> light;
  light->SetLightTypeToCameraLight();
  light->SetPosition(from[0], from[1], from[2]);
  light->SetFocalPoint(0, 0, 0);
  light->SetIntensity(intensity);
  light->SetColor(color[0], color[1], color[2]);
  renderer->AddLight(light);
}

/// Lights that graze what faces the eye: a fold of angle a changes a facet's tone by a times the
/// sine of its angle to the light. What one light leaves even (a fold about the axis that points at
/// it) the other changes, and where both together keep the tone their tints differ: a warm key, a
/// cooler fill. The third, from below, keeps folds apart that neither reaches.
void add_raking_lights(vtkRenderer* renderer) {
  add_light(renderer, {-1.0, 0.8, 0.55}, 0.95, {1.0, 0.965, 0.915});
  add_light(renderer, {0.9, 0.55, 0.55}, 0.60, {0.83, 0.88, 1.0});
  add_light(renderer, {0.1, -1.0, 0.4}, 0.36, {1.0, 0.95, 0.90});
}

/// Paper gets a raking key and less fill: a fold is a change of tone, and there is little else to
/// see.
void set_lights(vtkRenderer* renderer, const PanelStyle& style) {
  const bool paper = style.material == PanelStyle::Material::paper;
  renderer->SetAutomaticLightCreation(false);
  if (style.raking) return add_raking_lights(renderer);
  const std::array<double, 3> key =
      paper ? std::array{-1.15, 1.05, 1.3} : std::array{-0.9, 1.1, 1.3};
  add_light(renderer, key, 1.0, {1.0, 0.985, 0.96});
  add_light(renderer, {1.4, 0.1, 0.9}, paper ? 0.40 : 0.42, {0.92, 0.96, 1.0});  // fill
  add_light(renderer, {0.5, 1.2, -1.0}, paper ? 0.25 : 0.40, {1.0, 1.0, 1.0});   // rim
}

void set_camera(vtkRenderer* renderer, const ViewWindow& window) {
  vtkCamera* camera = renderer->GetActiveCamera();
  const Eigen::Vector3d eye = window.center + 1.1 * window.depth_m * window.direction;
  camera->SetFocalPoint(window.center.x(), window.center.y(), window.center.z());
  camera->SetPosition(eye.x(), eye.y(), eye.z());
  camera->SetViewUp(window.up.x(), window.up.y(), window.up.z());
  camera->ParallelProjectionOn();
  camera->SetParallelScale(window.height_m / 2);
  camera->SetClippingRange(0.05 * window.depth_m, 2.2 * window.depth_m);
}

/// Obstacles reach out of the window's depth: the eye steps back, which a parallel projection does
/// not show.
void show_all_depths(vtkRenderer* renderer, const ViewWindow& window) {
  const Eigen::Vector3d eye =
      window.center + 20 * (window.depth_m + window.height_m) * window.direction;
  renderer->GetActiveCamera()->SetPosition(eye.x(), eye.y(), eye.z());
  renderer->ResetCameraClippingRange();
}

/// Edges are smoothed by drawing larger and averaging, at most to what software GL can address.
int supersampling(int width_px, int height_px) {
  constexpr int kLargestTarget = 8192;
  return std::clamp(kLargestTarget / std::max(width_px, height_px), 1, 4);
}

/// Averages blocks of `factor` by `factor` pixels of the window, rows from the top.
Picture read_pixels(vtkRenderWindow* window, int width, int height, int factor) {
  vtkNew<vtkUnsignedCharArray> pixels;
  window->GetPixelData(0, 0, width * factor - 1, height * factor - 1, 0, pixels);
  const unsigned char* bytes = pixels->GetPointer(0);
  Picture picture(width, height);
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      std::array<int, 3> sum{};
      for (int row = (height - 1 - y) * factor; row < (height - y) * factor; ++row) {
        const unsigned char* byte =
            bytes + 3 * (static_cast<std::ptrdiff_t>(row) * width + x) * factor;
        for (int i = 0; i < factor; ++i) {
          for (std::size_t c = 0; c < 3; ++c) sum[c] += *byte++;
        }
      }
      const int count = factor * factor;
      for (std::size_t c = 0; c < 3; ++c) {
        picture.at(x, y)[c] = static_cast<std::uint8_t>((sum[c] + count / 2) / count);
      }
    }
  }
  return picture;
}

Picture draw(vtkRenderer* renderer, int width_px, int height_px, int factor) {
  vtkNew<vtkRenderWindow> target;
  target->SetOffScreenRendering(1);
  target->SetMultiSamples(0);
  target->SetSize(factor * width_px, factor * height_px);
  target->AddRenderer(renderer);
  if (target->SupportsOpenGL() == 0) {
    throw Error("the display has no OpenGL 3.2", "render", "apt-get install libgl1-mesa-dri");
  }
  target->Render();
  Picture picture = read_pixels(target, width_px, height_px, factor);
  renderer->ReleaseGraphicsResources(target);
  return picture;
}

Picture draw_lit(const PanelActors& actors, const ViewWindow& window, const PanelStyle& style,
                 int width_px, int height_px) {
  vtkNew<vtkRenderer> renderer;
  renderer->SetBackground(1, 1, 1);
  for (const auto& actor : actors.opaque) renderer->AddActor(actor);
  for (const auto& actor : actors.faint) renderer->AddActor(actor);
  set_lights(renderer, style);
  set_camera(renderer, window);
  if (!actors.faint.empty()) show_all_depths(renderer, window);
  return draw(renderer, width_px, height_px, supersampling(width_px, height_px));
}

/// How open every pixel's surface is, 1 … 255; 0 where nothing is drawn. The scale is that of the
/// folds seen. One sample a pixel: occlusion is smooth, and it is what costs.
Picture draw_openness(const std::vector<vtkSmartPointer<vtkActor>>& actors,
                      const ViewWindow& window, int width_px, int height_px) {
  vtkNew<vtkRenderer> renderer;
  renderer->SetBackground(0, 0, 0);
  for (const auto& actor : actors) {
    vtkNew<vtkActor> plain;
    vtkNew<vtkPolyDataMapper> mapper;
    mapper->SetInputData(vtkPolyDataMapper::SafeDownCast(actor->GetMapper())->GetInput());
    mapper->ScalarVisibilityOff();
    plain->SetMapper(mapper);
    plain->SetPosition(actor->GetPosition());
    plain->GetProperty()->LightingOff();
    renderer->AddActor(plain);
  }
  set_camera(renderer, window);
  vtkNew<vtkRenderStepsPass> steps;
  vtkNew<vtkSSAOPass> occlusion;
  occlusion->SetRadius(0.07 * window.height_m);
  occlusion->SetBias(0.0012 * window.height_m);
  occlusion->SetKernelSize(128);
  occlusion->BlurOn();
  occlusion->SetDelegatePass(steps);
  vtkOpenGLRenderer::SafeDownCast(renderer)->SetPass(occlusion);
  return draw(renderer, width_px, height_px, 1);
}

/// One direction of a Gaussian blur (sigma 1.6 px) that mixes drawn pixels only.
Picture blurred(const Picture& openness, int dx, int dy) {
  constexpr std::array<double, 5> kWeight{1.0, 0.823, 0.458, 0.172, 0.044};
  Picture out = openness;
  for (int y = 0; y < openness.height; ++y) {
    for (int x = 0; x < openness.width; ++x) {
      if (openness.at(x, y)[0] == 0) continue;
      double sum = 0;
      double weight = 0;
      for (int i = -4; i <= 4; ++i) {
        const int u = std::clamp(x + i * dx, 0, openness.width - 1);
        const int v = std::clamp(y + i * dy, 0, openness.height - 1);
        const std::uint8_t value = openness.at(u, v)[0];
        if (value == 0) continue;
        sum += kWeight[std::abs(i)] * value;
        weight += kWeight[std::abs(i)];
      }
      out.at(x, y).fill(static_cast<std::uint8_t>(std::lround(sum / weight)));
    }
  }
  return out;
}

}  // namespace

Picture draw_panel(const PanelParts& parts, const ViewWindow& window, const PanelStyle& style,
                   int width_px, int height_px) {
  const PanelActors actors = make_actors(parts, window, style, supersampling(width_px, height_px));
  Picture picture = draw_lit(actors, window, style, width_px, height_px);
  const Picture openness =
      blurred(blurred(draw_openness(actors.opaque, window, width_px, height_px), 1, 0), 0, 1);
  for (std::size_t i = 0; i < picture.pixels.size(); ++i) {
    const double open = openness.pixels[i][0] == 0 ? 1.0 : openness.pixels[i][0] / 255.0;
    for (std::uint8_t& channel : picture.pixels[i]) {
      channel = static_cast<std::uint8_t>(std::lround(channel * open));
    }
  }
  return picture;
}

}  // namespace geoprior
