// Reads CAD files as shapes.
#include <fmt/format.h>
#include <BRepTools.hxx>
#include <BRep_Builder.hxx>
#include <IGESControl_Reader.hxx>
#include <Interface_Static.hxx>
#include <Message.hxx>
#include <Message_Messenger.hxx>
#include <Message_Printer.hxx>
#include <STEPControl_Reader.hxx>
#include <Standard_OutOfMemory.hxx>
#include <TopoDS_Shape.hxx>

#include <array>
#include <fstream>
#include <new>

#include "collarmesh/brep/cad_model.h"
#include "sphere_sides.h"
#include "step_labels.h"
#include "topology.h"

namespace collarmesh::brep {

namespace {

/// A capture of standard output, where OpenCASCADE reports the errors of a BREP file.
class CapturedOutput {
 public:
  CapturedOutput() : before_(std::cout.rdbuf(text_.rdbuf())) {}
  ~CapturedOutput() { std::cout.rdbuf(before_); }
  CapturedOutput(const CapturedOutput&) = delete;
  CapturedOutput& operator=(const CapturedOutput&) = delete;

  /// Returns the captured text on one line.
  std::string text() const {
    std::string text = text_.str();
    while (!text.empty() && text.back() == '\n') text.pop_back();
    std::replace(text.begin(), text.end(), '\n', ' ');
    return text;
  }

 private:
  std::ostringstream text_;
  std::streambuf* before_;
};

TopoDS_Shape read_brep(const std::string& path) {
  TopoDS_Shape shape;
  const CapturedOutput said;
  try {
    std::ifstream file(path);
    // OpenCASCADE reads words from a stream until it recognizes one, even at the end of the stream; these
    // exceptions stop it.
    file.exceptions(std::ios::failbit | std::ios::badbit);
    BRepTools::Read(shape, file, BRep_Builder());
  } catch (const std::ios::failure&) {
    shape.Nullify();
  }
  if (shape.IsNull())
    throw ReadError(
        fmt::format("{}: this is not a BREP text file, or it is cut off; export the shape again{}", path,
                    said.text().empty() ? "" : fmt::format(" (OpenCASCADE: {})", said.text())));
  return shape;
}

TopoDS_Shape read_exchange(const std::string& path, const char* format, XSControl_Reader& reader) {
  Interface_Static::SetCVal("xstep.cascade.unit", "MM");
  if (reader.ReadFile(path.c_str()) != IFSelect_RetDone)
    throw ReadError(
        fmt::format("{}: this is not {} data, or it is cut off; export the shape again", path, format));
  reader.TransferRoots();
  const TopoDS_Shape shape = reader.OneShape();
  if (shape.IsNull())
    throw ReadError(fmt::format(
        "{}: the {} file has no shape that can be read; export its solids or faces again, or as .brep", path,
        format));
  return shape;
}

/// Returns the labels; none if OpenCASCADE fails on them, because a shape without labels can be used, too.
CadLabels labels_of(const STEPControl_Reader& reader, const TopoDS_Shape& shape) {
  try {
    return step_labels(reader, shape);
  } catch (const Standard_OutOfMemory&) {
    throw;
  } catch (const Standard_Failure&) {
    return {};
  }
}

/// Mends faces of spheres. Ignores a failure of OpenCASCADE, because the shape can be used without this.
void mend(const STEPControl_Reader& reader, const TopoDS_Shape& shape) {
  try {
    mend_sphere_sides(reader, shape);
  } catch (const Standard_OutOfMemory&) {
    throw;
  } catch (const Standard_Failure&) {
    return;
  }
}

TopoDS_Shape read_step(const std::string& path, CadLabels& labels) {
  STEPControl_Reader reader;
  TopoDS_Shape shape = read_exchange(path, "STEP", reader);
  mend(reader, shape);
  labels = labels_of(reader, shape);
  return shape;
}

TopoDS_Shape read_iges(const std::string& path) {
  IGESControl_Reader reader;
  return read_exchange(path, "IGES", reader);
}

TopoDS_Shape read_shape(const std::string& path, CadFormat format, CadLabels& labels) {
  Message::DefaultMessenger()->RemovePrinters(STANDARD_TYPE(Message_Printer));
  try {
    switch (format) {
      case CadFormat::brep: return read_brep(path);
      case CadFormat::step: return read_step(path, labels);
      case CadFormat::iges: return read_iges(path);
      case CadFormat::other: break;
    }
  } catch (const Standard_OutOfMemory&) {
    throw std::bad_alloc();
  } catch (const Standard_Failure& failure) {
    throw ReadError(fmt::format(
        "{}: OpenCASCADE cannot read it ({}); export it again, or in another format: .step, .brep, .stl",
        path, text(failure)));
  }
  throw ReadError(fmt::format("{}: not known as a CAD file; use {}", path, fmt::join(cad_formats(), " ")));
}

}  // namespace

CadModel read_cad(const std::string& path, std::string_view format, const CadOptions& options) {
  CadLabels labels;
  const TopoDS_Shape shape = read_shape(path, cad_format_of(path, format), labels);
  return {shape, path, options, std::move(labels)};
}

}  // namespace collarmesh::brep
