#include "cases/mesh/vtk_parts.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <set>
#include <vtkCellData.h>
#include <vtkCellType.h>
#include <vtkDataArray.h>
#include <vtkIdList.h>

namespace springproof::cases {

namespace {

/// Names of cell data that programs give to groups: meshio's of gmsh's and of Medit's files, others'.
constexpr std::array<const char*, 6> names_of_groups{"gmsh:physical", "medit:ref", "region",
                                                     "cell_tags",     "material",  "MaterialIDs"};
constexpr std::size_t most_groups = 1000;

struct CellType {
  int number; ///< VTK's
  ElementKind kind;
  bool is_linear;
};
constexpr std::array<CellType, 24> cell_types{{{VTK_VERTEX, ElementKind::point, true},
                                               {VTK_LINE, ElementKind::line, true},
                                               {VTK_QUADRATIC_EDGE, ElementKind::line, false},
                                               {VTK_LAGRANGE_CURVE, ElementKind::line, false},
                                               {VTK_TRIANGLE, ElementKind::triangle, true},
                                               {VTK_QUADRATIC_TRIANGLE, ElementKind::triangle, false},
                                               {VTK_BIQUADRATIC_TRIANGLE, ElementKind::triangle, false},
                                               {VTK_LAGRANGE_TRIANGLE, ElementKind::triangle, false},
                                               {VTK_QUAD, ElementKind::quadrangle, true},
                                               {VTK_PIXEL, ElementKind::quadrangle, true},
                                               {VTK_QUADRATIC_QUAD, ElementKind::quadrangle, false},
                                               {VTK_BIQUADRATIC_QUAD, ElementKind::quadrangle, false},
                                               {VTK_LAGRANGE_QUADRILATERAL, ElementKind::quadrangle, false},
                                               {VTK_TETRA, ElementKind::tetrahedron, true},
                                               {VTK_QUADRATIC_TETRA, ElementKind::tetrahedron, false},
                                               {VTK_LAGRANGE_TETRAHEDRON, ElementKind::tetrahedron, false},
                                               {VTK_HEXAHEDRON, ElementKind::hexahedron, true},
                                               {VTK_VOXEL, ElementKind::hexahedron, true},
                                               {VTK_QUADRATIC_HEXAHEDRON, ElementKind::hexahedron, false},
                                               {VTK_TRIQUADRATIC_HEXAHEDRON, ElementKind::hexahedron, false},
                                               {VTK_LAGRANGE_HEXAHEDRON, ElementKind::hexahedron, false},
                                               {VTK_WEDGE, ElementKind::wedge, true},
                                               {VTK_QUADRATIC_WEDGE, ElementKind::wedge, false},
                                               {VTK_PYRAMID, ElementKind::pyramid, true}}};

/// A number for every cell, each a whole one.
using Values = std::vector<int>;

std::optional<Values> whole_numbers(vtkDataArray& array) {
  if (array.GetNumberOfComponents() != 1) return std::nullopt;
  Values values;
  for (vtkIdType c = 0; c < array.GetNumberOfTuples(); ++c) {
    const double value = array.GetTuple1(c);
    if (!(std::abs(value) < 2147483648.0) || value != std::floor(value)) return std::nullopt;
    values.push_back(static_cast<int>(value));
  }
  return values;
}

std::size_t n_different(const Values& values) {
  return std::set<int>(values.begin(), values.end()).size();
}

/// Cell data that may be groups: whole numbers of few different values.
bool may_be_groups(vtkDataArray& array) {
  if (array.GetDataType() == VTK_FLOAT || array.GetDataType() == VTK_DOUBLE) return false;
  const auto values = whole_numbers(array);
  return values && n_different(*values) <= most_groups;
}

std::string name_of_array(vtkDataSet& data, int number) {
  const char* const name = data.GetCellData()->GetArrayName(number);
  return name ? name : "";
}

std::string list_of(const std::vector<std::string>& names) {
  std::string list;
  for (const std::string& name : names) list += (list.empty() ? "'" : ", '") + name + "'";
  return list;
}

/// The numbers that the case asks for.
Values chosen_groups(vtkDataSet& data, const std::string& name) {
  vtkDataArray* const array = data.GetCellData()->GetArray(name.c_str());
  std::vector<std::string> known;
  for (int a = 0; a < data.GetCellData()->GetNumberOfArrays(); ++a)
    if (vtkDataArray* const one = data.GetCellData()->GetArray(a); one && whole_numbers(*one))
      known.push_back(name_of_array(data, a));
  const auto values = array ? whole_numbers(*array) : std::nullopt;
  if (!values)
    refuse("has no whole number '" + name + "' of each cell, which groups asks for; it has " +
           (known.empty() ? "none" : list_of(known)));
  if (n_different(*values) > most_groups)
    refuse("has " + std::to_string(n_different(*values)) + " different values of '" + name +
           "', must have at most " + std::to_string(most_groups) + " groups");
  return *values;
}

/// The numbers that a program has called groups, or the only ones; none if there are others.
std::optional<Values> likely_groups(vtkDataSet& data, std::vector<std::string>& remarks) {
  std::vector<std::string> likely;
  for (int a = 0; a < data.GetCellData()->GetNumberOfArrays(); ++a)
    if (vtkDataArray* const array = data.GetCellData()->GetArray(a); array && may_be_groups(*array))
      likely.push_back(name_of_array(data, a));
  if (likely.empty()) return std::nullopt;
  const auto known = std::find_if(names_of_groups.begin(), names_of_groups.end(), [&](const char* name) {
    return std::find(likely.begin(), likely.end(), name) != likely.end();
  });
  if (known == names_of_groups.end() && likely.size() > 1) {
    remarks.push_back("has whole numbers " + list_of(likely) +
                      " of its cells; body.groups = \"NAME\" makes groups of one of them");
    return std::nullopt;
  }
  const std::string name = known == names_of_groups.end() ? likely.front() : *known;
  remarks.push_back("groups are named by the values of '" + name + "' of its cells");
  return whole_numbers(*data.GetCellData()->GetArray(name.c_str()));
}

/// VTK numbers the corners of pixels and voxels row by row.
void put_around(int type, vtkIdList& corners) {
  const auto swap = [&](vtkIdType a, vtkIdType b) {
    const vtkIdType first = corners.GetId(a);
    corners.SetId(a, corners.GetId(b));
    corners.SetId(b, first);
  };
  if (type == VTK_PIXEL || type == VTK_VOXEL) swap(2, 3);
  if (type == VTK_VOXEL) swap(6, 7);
}

void add_cells(vtkDataSet& data, const std::optional<Values>& group_of, MeshFileContent& content) {
  std::map<std::array<int, 4>, FileElements> all; // by dimension, group, kind, whether linear
  const vtkNew<vtkIdList> corners;
  for (vtkIdType c = 0; c < data.GetNumberOfCells(); ++c) {
    const int type = data.GetCellType(c);
    const auto known = std::find_if(cell_types.begin(), cell_types.end(),
                                    [&](const CellType& one) { return one.number == type; });
    if (known == cell_types.end())
      refuse("has cells of VTK's type " + std::to_string(type) +
             ", must have tetrahedra or hexahedra, and triangles or quadrangles of their surface");
    const ElementKindTraits& traits = traits_of(known->kind);
    data.GetCellPoints(c, corners);
    if (corners->GetNumberOfIds() < traits.n_corners)
      refuse("cell " + std::to_string(c) + " has " + std::to_string(corners->GetNumberOfIds()) +
             " points, must have " + std::to_string(traits.n_corners));
    put_around(type, *corners);
    const int group = group_of ? (*group_of)[index(c)] : 0;
    FileElements& elements =
        all[{traits.dimension, group, static_cast<int>(known->kind), known->is_linear ? 1 : 0}];
    elements.kind = known->kind;
    elements.is_linear = known->is_linear;
    elements.tags.push_back(index(c));
    for (vtkIdType v = 0; v < traits.n_corners; ++v) {
      const vtkIdType point = corners->GetId(v);
      if (point < 0 || point >= data.GetNumberOfPoints())
        refuse("cell " + std::to_string(c) + " has point " + std::to_string(point) +
               ", which does not exist");
      elements.nodes.push_back(index(point));
    }
  }
  for (auto& [key, elements] : all) {
    auto& of_group = content.elements[{key[0], key[1]}];
    if (of_group.empty() && group_of) content.groups.push_back({key[0], key[1], "", {key[1]}});
    of_group.push_back(std::move(elements));
  }
}

} // namespace

MeshFileContent read_mesh_cells(const std::string& content, const std::string& groups) {
  const DataSet data = read_data_set(content);
  MeshFileContent result;
  for (vtkIdType p = 0; p < data->GetNumberOfPoints(); ++p) {
    result.nodes.push_back(index(p));
    std::array<double, 3> point{};
    data->GetPoint(p, point.data());
    result.coordinates.insert(result.coordinates.end(), point.begin(), point.end());
  }
  const auto group_of =
      groups.empty() ? likely_groups(*data, result.remarks) : std::optional(chosen_groups(*data, groups));
  if (group_of && group_of->size() != index(data->GetNumberOfCells()))
    refuse("has not as many numbers of its cells as cells");
  add_cells(*data, group_of, result);
  return result;
}

} // namespace springproof::cases
