#include "files/cad_files.h"

#include <dlfcn.h>
#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <filesystem>
#include <system_error>
#include <utility>

#include "collarmesh/brep/cad_model.h"
#include "collarmesh/error.h"
#include "common/thread_limit.h"

namespace collarmesh::files {

namespace {

// Reads a CAD file with the module, which is loaded on first use: OpenCASCADE's libraries take longer to load
// than a small mesh takes to make.
std::unique_ptr<brep::CadModel> read_by_module(const std::string& path, std::string_view format,
                                               const brep::CadOptions& options) {
  constexpr const char* module = "collarmesh_cad.so";
  // Searches along the run path of the program. The module stays loaded, because its models may be used until
  // the program ends.
  void* const loaded = dlopen(module, RTLD_NOW | RTLD_LOCAL);
  void* const found = loaded == nullptr ? nullptr : dlsym(loaded, COLLARMESH_READ_CAD);
  if (found == nullptr)
    throw ReadError(
        fmt::format("{}: cannot be read, because {} cannot be loaded ({}); build collarmesh with OpenCASCADE "
                    "(package libocct-data-exchange-dev), or name the module's folder in LD_LIBRARY_PATH, or "
                    "export the shape as .stl",
                    path, module, dlerror()));
  std::unique_ptr<brep::CadModel> model;
  using Read = void (*)(const std::string&, std::string_view, const brep::CadOptions&,
                        std::unique_ptr<brep::CadModel>&);
  reinterpret_cast<Read>(found)(path, format, options, model);
  return model;
}

/// Returns the time in seconds that reading a file, or cutting its faces into triangles, may take if the
/// program has no time limit.
double patience_with(const std::string& path) {
  constexpr double at_least = 600, for_a_megabyte = 60;
  std::error_code error;
  const auto size = std::filesystem::file_size(path, error);
  return at_least + (error ? 0 : for_a_megabyte * static_cast<double>(size) / 1e6);
}

}  // namespace

struct CadFiles::File {
  std::unique_ptr<brep::CadModel> model;
  double deflection;
  unsigned threads;
  Index first_soup, soup_count;
  mutable std::optional<brep::CadMeasures> measures = {};  // measures of these soups, computed on first use

  /// Replaces the triangles of this file's soups by those that `options` give.
  void cut_again(const brep::TessellationOptions& options, std::vector<PolygonSoup>& soups) {
    std::vector<PolygonSoup> own;
    ThreadLimit(threads).run([&] { own = model->tessellate(options); });
    assert(own.size() == soup_count);
    std::move(own.begin(), own.end(), soups.begin() + first_soup);
    measures.reset();
  }
};

CadFiles::CadFiles(CadGuard guard) : guard_(std::move(guard)) {}
CadFiles::~CadFiles() = default;
CadFiles::CadFiles(CadFiles&&) noexcept = default;
CadFiles& CadFiles::operator=(CadFiles&&) noexcept = default;

std::vector<std::string> CadFiles::formats() { return brep::cad_formats(); }
bool CadFiles::knows(const std::string& path, std::string_view format) {
  return brep::is_cad_format(path, format);
}
bool CadFiles::empty() const { return files_.empty(); }

void CadFiles::read(const std::string& path, std::string_view format, const CadReading& reading,
                    std::vector<PolygonSoup>& soups) {
  const brep::Overlap overlap =
      reading.overlap == SolidOverlap::region ? brep::Overlap::region : brep::Overlap::first;
  const double patience = patience_with(path);
  std::shared_ptr<void> work = guarded("reading the file and finding its solids", path, patience);
  std::unique_ptr<brep::CadModel> model;
  ThreadLimit limit(reading.threads);  // also limits OpenCASCADE, which uses TBB's threads
  limit.run([&] { model = read_by_module(path, format, {.overlap = overlap}); });
  const double absolute = reading.deflection(model->diagonal());
  work.reset();
  work = guarded("cutting faces into triangles", path, patience);
  std::vector<PolygonSoup> own;
  limit.run([&] { own = model->tessellate({.deflection = absolute}); });
  files_.push_back({std::move(model), absolute, reading.threads, static_cast<Index>(soups.size()),
                    static_cast<Index>(own.size())});
  std::move(own.begin(), own.end(), std::back_inserter(soups));
}

void CadFiles::tessellate(double finer, std::vector<PolygonSoup>& soups) {
  for (File& file : files_) {
    const auto cutting = guarded("cutting faces into finer triangles", file.model->name());
    file.cut_again(
        {.deflection = file.deflection / finer, .angle = brep::TessellationOptions().angle / finer}, soups);
  }
}

void CadFiles::tessellate(double finer, const std::set<std::pair<Index, Tag>>& faces,
                          std::vector<PolygonSoup>& soups) {
  for (File& file : files_) {
    brep::TessellationOptions options{.deflection = file.deflection, .finer = finer};
    for (const auto& [soup, number] : faces)
      if (file_of(soup) == &file) options.finer_faces.push_back(number);
    if (options.finer_faces.empty()) continue;
    const auto cutting = guarded("cutting faces into finer triangles", file.model->name());
    file.cut_again(options, soups);
  }
}

const CadFiles::File* CadFiles::file_of(Index soup) const {
  for (const File& file : files_)
    if (soup >= file.first_soup && soup - file.first_soup < file.soup_count) return &file;
  return nullptr;
}

std::optional<Point> CadFiles::nearest(Index soup, unsigned dimension, Tag number, const Point& p) const {
  const File* const file = file_of(soup);
  return file == nullptr ? std::nullopt : file->model->nearest(dimension, number, p);
}

std::optional<CadFiles::Measured> CadFiles::measures(Index soup) const {
  const File* const file = file_of(soup);
  if (file == nullptr) return std::nullopt;
  if (!file->measures) {
    const auto measuring = guarded("measuring its faces", file->model->name());
    file->measures = file->model->measures();
  }
  return Measured{*file->measures, file->first_soup};
}

std::string CadFiles::names() const {
  std::string names;
  for (const File& file : files_) names += (names.empty() ? "" : ", ") + file.model->name();
  return names;
}

const brep::CadLabels* CadFiles::labels(std::size_t soups) const {
  const bool alone = files_.size() == 1 && files_.front().soup_count == soups;
  return alone ? &files_.front().model->labels() : nullptr;
}

std::string CadFiles::faces_near(const Point& where) const {
  const auto nearest = std::min_element(files_.begin(), files_.end(), [&](const File& a, const File& b) {
    return a.model->distance_to(where) < b.model->distance_to(where);
  });
  return nearest == files_.end()
             ? std::string()
             : fmt::format("{} of {}", nearest->model->faces_near(where), nearest->model->name());
}

std::string CadFiles::invalid_parts() const {
  std::string parts;
  for (const File& file : files_) {
    const auto checking = guarded("checking the shape", file.model->name());
    const std::string own = file.model->invalid_parts();
    if (!own.empty()) parts += fmt::format("{}{}: {}", parts.empty() ? "" : "; ", file.model->name(), own);
  }
  return parts;
}

std::vector<std::pair<Tag, Tag>> CadFiles::replaced_faces() const {
  std::vector<std::pair<Tag, Tag>> replaced;
  for (const File& file : files_) {
    const auto& own = file.model->replaced_faces();
    replaced.insert(replaced.end(), own.begin(), own.end());
  }
  return replaced;
}

bool CadFiles::fused() const {
  return std::all_of(files_.begin(), files_.end(), [](const File& file) { return file.model->fused(); });
}

std::string CadFiles::open_edges() const {
  std::string text;
  for (const File& file : files_) {
    const std::string& own = file.model->open_edges_text();
    if (!own.empty()) text += (text.empty() ? "" : " ") + own;
  }
  return text;
}

std::vector<std::string> CadFiles::notes(bool of_solids) const {
  std::vector<std::string> notes;
  for (const File& file : files_) {
    const std::string &open = file.model->open_edges_text(), prefix = file.model->name() + ": ";
    for (const std::string& note : file.model->notes()) {
      const std::string sentence = note.starts_with(prefix) ? note.substr(prefix.size()) : note;
      if (of_solids || open.find(sentence) == std::string::npos) notes.push_back(note);
    }
  }
  return notes;
}

}  // namespace collarmesh::files
