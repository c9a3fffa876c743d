// The water material: a fragment shader in place of VTK's lights.

#include "testbed/view/panel/water.h"

#include <vtkActor.h>
#include <vtkProperty.h>
#include <vtkShaderProperty.h>

#include <cstdio>
#include <string>

namespace geoprior {
namespace {

std::string vec3(const Eigen::Vector3d& v) {
  char text[128];
  std::snprintf(text, sizeof text, "vec3(%.7g, %.7g, %.7g)", v.x(), v.y(), v.z());
  return text;
}

// After VTK's own lighting, whose result it replaces. View coordinates: the eye is towards +z
// (parallel projection); `toWorld` turns them into the scene's, where z is up.
constexpr const char* kShader = R"(
  vec3 waterNormal = normalize(normalVCVSOutput);
  vec3 mirrored = reflect(vec3(0.0, 0.0, -1.0), waterNormal);
  float facing = clamp(waterNormal.z, 0.0, 1.0);
  float fresnel = 0.045 + 0.955 * pow(1.0 - facing, 5.0);
  vec3 up = toWorld * waterNormal;
  vec3 seen = toWorld * mirrored;
  vec3 zenith = vec3(0.46, 0.66, 0.88);
  vec3 horizon = vec3(0.97, 0.98, 0.99);
  vec3 sky = mix(horizon, zenith, smoothstep(0.0, 0.75, seen.z));
  sky = mix(vec3(0.10, 0.26, 0.33), sky, smoothstep(-0.25, 0.08, seen.z));
  vec3 sun = normalize(vec3(-0.9, 1.1, 1.3));
  float towards = max(dot(mirrored, sun), 0.0);
  float glint = 0.9 * pow(towards, 220.0) + 0.16 * pow(towards, 14.0);
  float lit = 0.62 + 0.38 * max(dot(waterNormal, sun), 0.0);
  vec3 deep = vec3(0.05, 0.265, 0.365);
  vec3 thin = vec3(0.29, 0.63, 0.68);
  vec3 body = mix(thin, deep, pow(facing, 1.3)) * (0.80 + 0.20 * up.z);
  TINT
  vec3 water = body * lit * (1.0 - fresnel) + sky * fresnel + vec3(glint);
  fragOutput0 = vec4(min(water, vec3(1.0)), fragOutput0.a);
)";

std::string tint_code(WaterTint tint, const Eigen::Vector3d& ground) {
  switch (tint) {
    case WaterTint::none:
      return "";
    case WaterTint::all:
      return "body = mix(body, diffuseColor, 0.72);";
    case WaterTint::but_ground:
      break;
  }
  // The waves of a tinted place stay visible: its paint is as light or dark as the water was.
  return "float relief = clamp(dot(body, vec3(1.0)) / 1.15, 0.55, 1.2);\n"
         "  body = mix(body, diffuseColor * relief, 0.82 * smoothstep(0.0, 0.3, "
         "distance(diffuseColor, " +
         vec3(ground) + ")));";
}

}  // namespace

void shade_as_water(vtkActor* actor, const ViewWindow& window, WaterTint tint,
                    const std::array<double, 3>& ground) {
  std::string code = kShader;
  code.replace(code.find("TINT"), 4, tint_code(tint, {ground[0], ground[1], ground[2]}));
  const std::string to_world = "  mat3 toWorld = mat3(" + vec3(window.right) + ", " +
                               vec3(window.up) + ", " + vec3(window.direction) + ");\n";
  actor->GetShaderProperty()->AddFragmentShaderReplacement(
      "//VTK::Light::Impl", true, "//VTK::Light::Impl\n" + to_world + code, false);
  vtkProperty* material = actor->GetProperty();
  material->SetInterpolationToPhong();
  material->SetAmbient(0);
  material->SetDiffuse(1);
  material->SetSpecular(0);
}

}  // namespace geoprior
