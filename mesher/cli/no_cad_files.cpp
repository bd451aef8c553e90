// Built in place of cad_files.cpp where OpenCASCADE is not there.
#include "cad_files.h"

namespace collarmesh::cli {

struct CadFiles::File {};

CadFiles::CadFiles() = default;
CadFiles::~CadFiles() = default;
CadFiles::CadFiles(CadFiles&&) noexcept = default;
CadFiles& CadFiles::operator=(CadFiles&&) noexcept = default;

std::vector<std::string> CadFiles::formats() { return {}; }
bool CadFiles::knows(const std::string&, std::string_view) { return false; }
void CadFiles::read(const std::string&, std::string_view, double, std::vector<PolygonSoup>&) {}
bool CadFiles::empty() const { return true; }
void CadFiles::tessellate(double, std::vector<PolygonSoup>&) {}
std::optional<Point> CadFiles::nearest(Index, unsigned, Tag, const Point&) const { return std::nullopt; }
std::string CadFiles::faces_near(const Point&) const { return {}; }
std::string CadFiles::invalid_parts() const { return {}; }
std::vector<std::string> CadFiles::notes() const { return {}; }

}  // namespace collarmesh::cli
