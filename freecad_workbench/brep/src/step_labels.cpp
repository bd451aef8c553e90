// Reads names and colours of a STEP file. Entities with a name or colour are traced to the shapes that the
// reader made of them. Sub-shapes are identified by their geometry (TShape), which instances of a product
// share.
#include "step_labels.h"

#include <Interface_InterfaceModel.hxx>
#include <Quantity_Color.hxx>
#include <STEPConstruct.hxx>
#include <STEPConstruct_Styles.hxx>
#include <STEPControl_Reader.hxx>
#include <StepBasic_Product.hxx>
#include <StepBasic_ProductDefinition.hxx>
#include <StepBasic_ProductDefinitionFormation.hxx>
#include <StepShape_SolidModel.hxx>
#include <StepVisual_Colour.hxx>
#include <StepVisual_PresentationStyleAssignment.hxx>
#include <StepVisual_PresentationStyleByContext.hxx>
#include <StepVisual_StyledItem.hxx>
#include <TCollection_HAsciiString.hxx>
#include <TopoDS_Iterator.hxx>
#include <TransferBRep.hxx>
#include <Transfer_TransientProcess.hxx>
#include <XSControl_TransferReader.hxx>
#include <XSControl_WorkSession.hxx>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "topology.h"

namespace collarmesh::brep {

namespace {

using Geometry = const TopoDS_TShape*;
Geometry geometry_of(const TopoDS_Shape& shape) { return shape.TShape().get(); }

std::string text_of(const Handle(TCollection_HAsciiString) & text) {
  return text.IsNull() ? std::string() : std::string(text->ToCString());
}

/// Returns whether OpenCASCADE's writer made up the name, as it does for products without a name.
bool is_of_writer(const std::string& name) { return name.starts_with("Open CASCADE STEP translator"); }

/// Returns the number of levels from a shape down to its first solid.
std::size_t depth_of(const TopoDS_Shape& shape) {
  std::size_t depth = 0;
  TopoDS_Shape inner = shape;
  for (TopoDS_Iterator part(inner); inner.ShapeType() < TopAbs_SOLID && part.More(); part.Initialize(inner)) {
    inner = part.Value();
    ++depth;
  }
  return depth;
}

class StepNames {
 public:
  explicit StepNames(const STEPControl_Reader& reader)
      : process_(reader.WS()->TransferReader()->TransientProcess()) {
    const Handle(Interface_InterfaceModel) model = reader.WS()->Model();
    for (int i = 1; i <= model->NbEntities(); ++i) {
      const Handle(Standard_Transient) entity = model->Value(i);
      if (const auto solid = Handle(StepShape_SolidModel)::DownCast(entity); !solid.IsNull())
        add(*solid, shape_of(entity));
      else if (const auto product = Handle(StepBasic_ProductDefinition)::DownCast(entity); !product.IsNull())
        add(*product, shape_of(entity));
    }
    for (const auto& [solid, product] : product_of_) ++products_[product].own;
    for (const Product& product : products_)
      if (product.own > 0) ++products_of_solids_;
  }

  /// Returns the name of the innermost product that contains a solid. If this product has several solids, the
  /// solid's own name follows, or stands alone if no other product has solids.
  std::string find(const TopoDS_Shape& solid) const {
    const auto found = own_.find(geometry_of(solid));
    std::string own = found == own_.end() ? std::string() : found->second;
    const auto in = product_of_.find(geometry_of(solid));
    if (in == product_of_.end() || products_[in->second].name.empty()) return own;
    const Product& product = products_[in->second];
    if (product.own == 1 || own.empty()) return product.name;
    return products_of_solids_ == 1 ? own : product.name + " " + own;
  }

 private:
  struct Product {
    std::string name;
    std::size_t solids = 0;  // including those of the products inside
    std::size_t depth = 0;   // depth of its first solid
    std::size_t own = 0;     // solids that are in no product inside this one
  };

  TopoDS_Shape shape_of(const Handle(Standard_Transient) & entity) const {
    return TransferBRep::ShapeResult(process_, entity);
  }

  void add(const StepShape_SolidModel& solid, const TopoDS_Shape& shape) {
    const std::string name = text_of(solid.Name());
    if (shape.IsNull() || name.empty()) return;
    for (const TopoDS_Shape& part : subshapes(shape, TopAbs_SOLID)) own_[geometry_of(part)] = name;
  }

  void add(const StepBasic_ProductDefinition& definition, const TopoDS_Shape& shape) {
    if (shape.IsNull() || definition.Formation().IsNull() || definition.Formation()->OfProduct().IsNull())
      return;
    const StepBasic_Product& product = *definition.Formation()->OfProduct();
    std::string name = text_of(product.Name());
    if (name.empty()) name = text_of(product.Id());
    if (is_of_writer(name)) name.clear();
    std::set<Geometry> solids;
    for (const TopoDS_Shape& solid : subshapes(shape, TopAbs_SOLID)) solids.insert(geometry_of(solid));
    const Product added{std::move(name), solids.size(), depth_of(shape)};
    for (const Geometry solid : solids) {
      const auto [found, first] = product_of_.try_emplace(solid, products_.size());
      const Product& before = first ? added : products_[found->second];
      if (std::pair(added.solids, added.depth) < std::pair(before.solids, before.depth))
        found->second = products_.size();
    }
    products_.push_back(added);
  }

  Handle(Transfer_TransientProcess) process_;
  std::map<Geometry, std::string> own_;
  std::map<Geometry, std::size_t> product_of_;  // the innermost product of each solid
  std::vector<Product> products_;
  std::size_t products_of_solids_ = 0;
};

/// Returns whether the style is that of an instance of a product.
bool is_of_instance(const StepVisual_StyledItem& style) {
  if (style.Styles().IsNull()) return false;
  for (int i = 1; i <= style.Styles()->Length(); ++i)
    if (!style.StylesValue(i).IsNull() &&
        style.StylesValue(i)->IsKind(STANDARD_TYPE(StepVisual_PresentationStyleByContext)))
      return true;
  return false;
}

std::optional<Colour> colour_of(const STEPConstruct_Styles& styles,
                                const Handle(StepVisual_StyledItem) & style) {
  Handle(StepVisual_Colour) surface, boundary, curve, rendered;
  double transparency = 0;
  bool of_component = false;
  styles.GetColors(style, surface, boundary, curve, rendered, transparency, of_component);
  const Handle(StepVisual_Colour)& shown = surface.IsNull() ? rendered : surface;
  Quantity_Color decoded;
  if (shown.IsNull() || !STEPConstruct_Styles::DecodeColor(shown, decoded)) return std::nullopt;
  std::array<double, 3> share{};
  decoded.Values(share[0], share[1], share[2], Quantity_TOC_sRGB);
  Colour colour = 0;
  for (const double s : share)
    colour = 256 * colour + static_cast<Colour>(std::lround(255 * std::clamp(s, 0.0, 1.0)));
  return colour;
}

using ByGeometry = std::map<Geometry, Colour>;

/// Returns the colours of sub-shapes of one kind. A later style replaces an earlier one, so larger shapes
/// must come first.
ByGeometry colours_of(const std::vector<std::pair<TopoDS_Shape, Colour>>& styled, TopAbs_ShapeEnum kind) {
  ByGeometry colours;
  for (const auto& [shape, colour] : styled)
    for (const TopoDS_Shape& part : subshapes(shape, kind)) colours[geometry_of(part)] = colour;
  return colours;
}

/// Returns shapes with their colours, larger ones before the shapes in them.
std::vector<std::pair<TopoDS_Shape, Colour>> styled_shapes(const STEPControl_Reader& reader) {
  STEPConstruct_Styles styles(reader.WS());
  std::vector<std::pair<TopoDS_Shape, Colour>> styled;
  if (!styles.LoadStyles()) return styled;
  const Handle(Transfer_TransientProcess) process = reader.WS()->TransferReader()->TransientProcess();
  for (int i = 1; i <= styles.NbStyles(); ++i) {
    const Handle(StepVisual_StyledItem) style = styles.Style(i);
    if (style.IsNull() || style->Item().IsNull() || is_of_instance(*style)) continue;
    const TopoDS_Shape shape = STEPConstruct::FindShape(process, style->Item());
    if (shape.IsNull()) continue;
    if (const auto colour = colour_of(styles, style)) styled.emplace_back(shape, *colour);
  }
  std::stable_sort(styled.begin(), styled.end(),
                   [](const auto& a, const auto& b) { return a.first.ShapeType() < b.first.ShapeType(); });
  return styled;
}

std::map<Tag, Colour> numbered(const TopoDS_Shape& shape, TopAbs_ShapeEnum kind, const ByGeometry& colours) {
  std::map<Tag, Colour> by_number;
  Tag number = 0;
  for (const TopoDS_Shape& part : subshapes(shape, kind)) {
    ++number;
    if (const auto found = colours.find(geometry_of(part)); found != colours.end())
      by_number.emplace_hint(by_number.end(), number, found->second);
  }
  return by_number;
}

}  // namespace

CadLabels step_labels(const STEPControl_Reader& reader, const TopoDS_Shape& shape) {
  CadLabels labels;
  const StepNames names(reader);
  Tag number = 0;
  for (const TopoDS_Shape& solid : subshapes(shape, TopAbs_SOLID)) {
    ++number;
    if (const std::string name = names.find(solid); !name.empty()) labels.solid_names.emplace(number, name);
  }
  const auto styled = styled_shapes(reader);
  labels.colours.patches = numbered(shape, TopAbs_FACE, colours_of(styled, TopAbs_FACE));
  labels.colours.regions = numbered(shape, TopAbs_SOLID, colours_of(styled, TopAbs_SOLID));
  return labels;
}

}  // namespace collarmesh::brep
