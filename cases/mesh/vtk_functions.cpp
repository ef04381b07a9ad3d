#include "cases/mesh/vtk_functions.hpp"

#include <algorithm>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <stdexcept>
#include <vtkAlgorithm.h>
#include <vtkCellData.h>
#include <vtkDoubleArray.h>
#include <vtkInformation.h>
#include <vtkInformationStringKey.h>
#include <vtkLogger.h>
#include <vtkNew.h>
#include <vtkObjectFactory.h>
#include <vtkOutputWindow.h>
#include <vtkPointData.h>
#include <vtkPolyData.h>
#include <vtkSTLReader.h>
#include <vtkStaticPointLocator.h>
#include <vtkUnstructuredGrid.h>
#include <vtkXMLUnstructuredGridReader.h>
#include <vtkXMLUnstructuredGridWriter.h>

namespace springproof::cases {

namespace {

/// Keeps the first of VTK's errors, without the place in VTK's source.
class FirstError : public vtkOutputWindow {
 public:
  static FirstError* New();
  /// @param message  "ERROR: In FILE, line N\nCLASS (ADDRESS): TEXT\n\n"
  void DisplayErrorText(const char* message) override {
    if (!text.empty()) return;
    text = message;
    const std::size_t address = text.find("): ");
    if (address != std::string::npos) text.erase(0, address + 3);
    text.erase(text.find_last_not_of(" \n") + 1);
  }
  void DisplayText(const char*) override {} // warnings
  std::string text;
};
vtkStandardNewMacro(FirstError)

    /// Runs a reader or writer, which prints nothing.
    /// @throws std::runtime_error with its first error
    void run(vtkAlgorithm& algorithm) {
  const vtkNew<FirstError> error;
  vtkOutputWindow::SetInstance(error);
  vtkLogger::SetStderrVerbosity(vtkLogger::VERBOSITY_OFF);
  algorithm.Update();
  if (!error->text.empty()) throw std::runtime_error(error->text);
}

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

vtkNew<vtkUnstructuredGrid> grid_of(const std::vector<Eigen::Vector3d>& nodes) {
  vtkNew<vtkPoints> points;
  points->SetData(array_of(PointField{"rest position", nodes}));
  vtkNew<vtkUnstructuredGrid> grid;
  grid->SetPoints(points);
  return grid;
}

std::string write(vtkUnstructuredGrid& grid, const GridFields& fields) {
  for (const auto& field : fields.point_vectors) grid.GetPointData()->AddArray(array_of(field));
  for (const auto& field : fields.point_numbers) grid.GetPointData()->AddArray(array_of(field));
  for (const auto& field : fields.cell_numbers) grid.GetCellData()->AddArray(array_of(field));
  for (const auto& field : fields.cell_tensors) grid.GetCellData()->AddArray(array_of(field));
  vtkNew<vtkXMLUnstructuredGridWriter> writer;
  writer->SetInputData(&grid);
  writer->SetDataModeToAppended();
  writer->EncodeAppendedDataOff();
  writer->SetCompressorTypeToNone();
  writer->SetHeaderTypeToUInt64();
  writer->WriteToOutputStringOn();
  run(*writer);
  return writer->GetOutputString();
}

std::string write_unstructured_grid(const HexMesh& mesh, const GridFields& fields) {
  const vtkNew<vtkUnstructuredGrid> grid = grid_of(mesh.nodes.to_vector());
  grid->AllocateEstimate(static_cast<vtkIdType>(mesh.cells.size()), 8);
  for (const std::array<int, 8>& cell : mesh.cells) {
    std::array<vtkIdType, 8> nodes;
    for (std::size_t v = 0; v < 8; ++v) nodes[v] = cell[around_cell[v]];
    grid->InsertNextCell(VTK_HEXAHEDRON, 8, nodes.data());
  }
  return write(*grid, fields);
}

std::string write_lines(const std::vector<Eigen::Vector3d>& points,
                        const std::vector<std::array<int, 2>>& lines, const GridFields& fields) {
  const vtkNew<vtkUnstructuredGrid> grid = grid_of(points);
  grid->AllocateEstimate(static_cast<vtkIdType>(lines.size()), 2);
  for (const auto& [i, j] : lines) {
    const std::array<vtkIdType, 2> ends{i, j};
    grid->InsertNextCell(VTK_LINE, 2, ends.data());
  }
  return write(*grid, fields);
}

std::vector<Eigen::Vector3d> vectors_of(vtkDataArray& array) {
  std::vector<Eigen::Vector3d> vectors(static_cast<std::size_t>(array.GetNumberOfTuples()));
  for (std::size_t p = 0; p < vectors.size(); ++p)
    array.GetTuple(static_cast<vtkIdType>(p), vectors[p].data());
  return vectors;
}

PointCloud read_unstructured_grid(const std::string& content) {
  vtkNew<vtkXMLUnstructuredGridReader> reader;
  reader->ReadFromInputStringOn();
  reader->SetInputString(content);
  run(*reader);
  vtkUnstructuredGrid& grid = *reader->GetOutput();
  PointCloud cloud;
  if (!grid.GetPoints()) return cloud;
  cloud.points = vectors_of(*grid.GetPoints()->GetData());
  cloud.is_single_precision = grid.GetPoints()->GetDataType() == VTK_FLOAT;
  for (int a = 0; a < grid.GetPointData()->GetNumberOfArrays(); ++a) {
    vtkDataArray* const array = grid.GetPointData()->GetArray(a); // null: strings
    if (array && array->GetNumberOfComponents() == 3 &&
        (array->GetDataType() == VTK_FLOAT || array->GetDataType() == VTK_DOUBLE))
      cloud.fields.push_back({array->GetName() ? array->GetName() : "", vectors_of(*array)});
  }
  return cloud;
}

/// The number of triangles that a binary file says that it has.
std::uint32_t stated_triangles(const std::string& path) {
  std::uint32_t count = 0;
  std::ifstream file(path, std::ios::binary);
  file.seekg(80).read(reinterpret_cast<char*>(&count), sizeof count);
  return count;
}

Surface read_triangles(const std::string& path) {
  constexpr std::uintmax_t head = 84, per_triangle = 50; // bytes of a binary file
  vtkNew<vtkSTLReader> reader;
  reader->SetFileName(path.c_str());
  reader->MergingOff(); // which must not see a position that is not finite
  run(*reader);
  vtkPolyData& body = *reader->GetOutput();
  Surface surface(static_cast<std::size_t>(body.GetNumberOfPolys()));
  if (reader->GetBinaryHeader() && std::filesystem::file_size(path) != head + per_triangle * surface.size())
    throw std::runtime_error(path + " ends within a triangle");
  if (reader->GetBinaryHeader() && stated_triangles(path) != surface.size())
    throw std::runtime_error(path + " has " + std::to_string(surface.size()) +
                             " triangles, and says that it has " + std::to_string(stated_triangles(path)));
  for (std::size_t t = 0; t < surface.size(); ++t)
    for (std::size_t v = 0; v < 3; ++v) // unmerged points follow each other
      body.GetPoint(static_cast<vtkIdType>(3 * t + v), surface[t][v].data());
  return surface;
}

std::vector<std::size_t> nearest_points(const std::vector<Eigen::Vector3d>& points,
                                        const std::vector<Eigen::Vector3d>& positions) {
  vtkNew<vtkStaticPointLocator> locator;
  locator->SetDataSet(grid_of(points));
  locator->BuildLocator();
  std::vector<std::size_t> nearest;
  for (const Eigen::Vector3d& position : positions)
    nearest.push_back(
        static_cast<std::size_t>(std::max<vtkIdType>(0, locator->FindClosestPoint(position.data()))));
  return nearest;
}

} // namespace

extern "C" const VtkFunctions springproof_vtk{write_unstructured_grid, write_lines, read_unstructured_grid,
                                              read_triangles, nearest_points};

} // namespace springproof::cases
