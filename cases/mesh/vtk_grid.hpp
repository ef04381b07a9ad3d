#pragma once

#include "cases/mesh/hex_mesh.hpp"
#include "cases/mesh/vtk_functions.hpp"

#include <cstring>
#include <vtkDoubleArray.h>
#include <vtkInformation.h>
#include <vtkInformationStringKey.h>
#include <vtkNew.h>
#include <vtkUnstructuredGrid.h>

/// VTK's form of our values.
namespace springproof::cases {

/// An array of numbers, vectors or symmetric tensors, its components named as ParaView shows them.
template<class Value>
vtkNew<vtkDoubleArray> array_of(const NamedValues<Value>& field) {
  constexpr int n = sizeof(Value) / sizeof(double);
  vtkNew<vtkDoubleArray> array;
  array->SetName(field.name.c_str());
  array->SetNumberOfComponents(n);
  const std::array<const char*, 3> of_vector{"X", "Y", "Z"};
  const std::array<const char*, 6> of_tensor{"XX", "YY", "ZZ", "XY", "YZ", "XZ"};
  for (std::size_t c = 0; c < n && n > 1; ++c)
    array->SetComponentName(static_cast<vtkIdType>(c), n == 3 ? of_vector[c] : of_tensor[c]);
  if (!field.unit.empty()) array->GetInformation()->Set(vtkDataArray::UNITS_LABEL(), field.unit.c_str());
  array->SetNumberOfTuples(static_cast<vtkIdType>(field.values.size()));
  std::memcpy(array->GetPointer(0), field.values.data(), field.values.size() * sizeof(Value));
  return array;
}

/// Points without cells.
inline vtkNew<vtkUnstructuredGrid> grid_of(const std::vector<Eigen::Vector3d>& nodes) {
  vtkNew<vtkPoints> points;
  points->SetData(array_of(PointField{"rest position", nodes}));
  vtkNew<vtkUnstructuredGrid> grid;
  grid->SetPoints(points);
  return grid;
}

/// A mesh without data.
inline vtkNew<vtkUnstructuredGrid> grid_of(const HexMesh& mesh) {
  vtkNew<vtkUnstructuredGrid> grid = grid_of(mesh.nodes.to_vector());
  grid->AllocateEstimate(static_cast<vtkIdType>(mesh.cells.size()), 8);
  for (const std::array<int, 8>& cell : mesh.cells) {
    std::array<vtkIdType, 8> nodes;
    for (std::size_t v = 0; v < 8; ++v) nodes[v] = cell[around_cell[v]];
    grid->InsertNextCell(VTK_HEXAHEDRON, 8, nodes.data());
  }
  return grid;
}

} // namespace springproof::cases
