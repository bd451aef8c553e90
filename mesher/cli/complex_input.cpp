#include "complex_input.h"

#include <fmt/format.h>

#include <algorithm>
#include <optional>

#include "collarmesh/error.h"
#include "input_files.h"
#include "interrupt.h"
#include "surface_files.h"

namespace collarmesh::cli {

namespace {

constexpr double share_of_triangles = 0.1;  // of the distance that the mesh may keep from the shape

bool may_be_too_coarse(const PlcError& error) {
  return std::all_of(error.faults.begin(), error.faults.end(), [](const PlcFault& fault) {
    return fault.kind == PlcFault::Kind::intersection || fault.kind == PlcFault::Kind::not_orientable;
  });
}

PlcError with_names(const PlcError& error, const CadFiles& cad) {
  std::vector<PlcFault> faults = error.faults;
  for (PlcFault& fault : faults)
    fault.message += fmt::format(" The nearest faces are {}.", cad.faces_near(fault.where));
  const std::string open = cad.open_edges(), invalid = cad.invalid_parts();
  return {
      fmt::format("{}{}{}", faults.empty() ? error.what() : faults.front().message,
                  open.empty() ? "" : fmt::format(" {}", open),
                  invalid.empty() ? "" : fmt::format(" OpenCASCADE finds the shape invalid: {}.", invalid)),
      faults};
}

}  // namespace

ComplexInput::ComplexInput(const std::vector<std::string>& paths, const std::string& format,
                           double distance) {
  for (const std::string& path : paths) {
    stop_if_interrupted();
    const std::string file = existing_file(path);
    if (CadFiles::knows(file, format))
      cad_.read(file, format, share_of_triangles * distance, soups_);
    else
      soups_.push_back(read_surface(file, format));
  }
}

Plc ComplexInput::build(const ComplexArguments& options) {
  if (cad_.empty()) return build_repaired(options);
  // Triangles of faces that nearly touch may meet where finer ones do not.
  std::optional<PlcError> first;
  for (const double finer : {1.0, 4.0}) {
    if (finer > 1) tessellate(finer);
    try {
      return take(remove_noise(build_plc(soups_, options.plc), soups_, options.plc, options.repair));
    } catch (const PlcError& error) {
      if (!first) first = with_names(error, cad_);
      if (!cad_.fused() || !may_be_too_coarse(error)) break;
    }
  }
  if (options.repair.mode == RepairMode::off) throw PlcError(*first);
  tessellate(1);
  try {
    return build_repaired(options);
  } catch (const PlcError&) {
    throw PlcError(*first);
  }
}

void ComplexInput::tessellate(double finer) {
  stop_if_interrupted();
  if (finer_ != finer) cad_.tessellate(finer, soups_);
  finer_ = finer;
}

Plc ComplexInput::build_repaired(const ComplexArguments& options) {
  return take(build_repaired_plc(soups_, options.plc, options.repair));
}

Plc ComplexInput::take(RepairedPlc result) {
  repaired_ = std::move(result.report);
  if (repaired_.repaired) soups_ = std::move(result.soups);
  return std::move(result.plc);
}

ExactGeometry ComplexInput::exact_geometry(const Plc& plc) const {
  return [this, &plc](unsigned dimension, Index feature, const Point& p) -> std::optional<Point> {
    const Index patch = dimension == 2                        ? feature
                        : plc.curves[feature].patches.empty() ? none
                                                              : plc.curves[feature].patches.front();
    if (patch == none) return std::nullopt;
    const Tag number = dimension == 2 ? plc.patches[feature].tag : plc.curves[feature].tag;
    return cad_.nearest(plc.patches[patch].file, dimension, number, p);
  };
}

MeshOptions ComplexInput::tightened(const MeshOptions& options, const Plc& plc) const {
  if (!has_cad()) return options;
  constexpr double default_distance = 1e-3;  // of the diagonal
  constexpr double distance_left = 0.75;     // the triangles' share twice, and some room
  constexpr double ratio_left = 0.99;
  MeshOptions tight = options;
  tight.distance =
      distance_left * (options.distance > 0 ? options.distance : default_distance * plc.bounds.diagonal());
  tight.radius_edge = std::max(1.0, ratio_left * options.radius_edge);
  return tight;
}

}  // namespace collarmesh::cli
