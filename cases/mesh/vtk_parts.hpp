#pragma once

#include "cases/mesh/vtk_functions.hpp"

#include <cstring>
#include <stdexcept>
#include <vtkDoubleArray.h>
#include <vtkInformation.h>
#include <vtkInformationStringKey.h>
#include <vtkNew.h>
#include <vtkSmartPointer.h>
#include <vtkUnstructuredGrid.h>

class vtkAlgorithm;
class vtkPolyData;

/// What the sources of the shared object springproof_vtk have for each other; VtkFunctions says what its
/// functions do.
namespace springproof::cases {

[[noreturn]] inline void refuse(const std::string& reason) {
  throw std::runtime_error(reason);
}

/// Runs a reader or writer of VTK's, which prints nothing.
/// @throws std::runtime_error with its first error, without the place in VTK's source
void run(vtkAlgorithm& algorithm);

/// The same for a reader that reads no more than what its file says about its content.
void run_information(vtkAlgorithm& algorithm);

using DataSet = vtkSmartPointer<vtkDataSet>;
template<class Reader>
DataSet read_xml(const std::string& content) {
  const vtkNew<Reader> reader;
  reader->ReadFromInputStringOn();
  reader->SetInputString(content);
  run(*reader);
  return vtkDataSet::SafeDownCast(reader->GetOutputDataObject(0));
}

/// The data set of a file's content.  @throws std::runtime_error if it has no points
DataSet read_data_set(const std::string& content);

/// The triangles of polygons and strips, which are divided.
Surface triangles_in(vtkPolyData& data);

PointCloud read_points(const std::string& content);
MeshFileContent read_mesh_cells(const std::string& content, const std::string& groups);
std::vector<double> distances_from(const TriangleMesh& surface, const std::vector<Eigen::Vector3d>& points);
CellCloud read_cells(const std::string& content, const Mesh& mesh);
Surface contour_of(const Picture& picture, const ContourSettings& settings);
Surface decimated_surface(const TriangleMesh& surface, std::size_t n_triangles);
std::vector<PlaceInCell> nearest_in_cells(const Mesh& mesh, const std::vector<Eigen::Vector3d>& positions);
Volume read_volume(const std::string& path, const VolumeBytes& bytes);
Placement read_placement(const std::string& path);

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
inline vtkNew<vtkUnstructuredGrid> grid_of(const Mesh& mesh) {
  vtkNew<vtkUnstructuredGrid> grid = grid_of(mesh.nodes.to_vector());
  grid->AllocateEstimate(static_cast<vtkIdType>(mesh.cells.size()), 8);
  const bool are_tetrahedra = mesh.shape == CellShape::tetrahedron;
  for (const CellNodes& cell : mesh.cells) {
    Few<vtkIdType, 8> nodes;
    for (std::size_t v = 0; v < cell.size(); ++v) nodes.push_back(cell[are_tetrahedra ? v : around_cell[v]]);
    grid->InsertNextCell(are_tetrahedra ? VTK_TETRA : VTK_HEXAHEDRON, static_cast<vtkIdType>(nodes.size()),
                         nodes.data());
  }
  return grid;
}

} // namespace springproof::cases
