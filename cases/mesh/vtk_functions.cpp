#include "cases/mesh/vtk_parts.hpp"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <vtkAlgorithm.h>
#include <vtkCellData.h>
#include <vtkLogger.h>
#include <vtkOBJReader.h>
#include <vtkObjectFactory.h>
#include <vtkOutputWindow.h>
#include <vtkPLYReader.h>
#include <vtkPointData.h>
#include <vtkPolyData.h>
#include <vtkSMPTools.h>
#include <vtkSTLReader.h>
#include <vtkStaticPointLocator.h>
#include <vtkXMLPolyDataReader.h>
#include <vtkXMLUnstructuredGridWriter.h>

namespace springproof::cases {

namespace {

/// Keeps the first of VTK's errors, without the place in VTK's source.
class FirstError : public vtkOutputWindow {
 public:
  static FirstError* New();
  /// @param message  "ERROR: In FILE, line N\nCLASS (ADDRESS): TEXT\n\n"
  void DisplayErrorText(const char* message) override {
    if (text.empty()) text = without_place(message);
  }
  /// Legacy files and pictures that end too early are no errors to VTK.
  void DisplayGenericWarningText(const char* message) override {
    const std::string warning = without_place(message);
    const auto says = [&](const char* words) { return warning.rfind(words, 0) == 0; };
    if (text.empty() && (says("Error reading") || says("File operation failed"))) text = warning;
  }
  void DisplayText(const char*) override {} // other warnings
  std::string text;

 private:
  static std::string without_place(std::string message) {
    const std::size_t address = message.find("): "), line = message.find('\n');
    if (address != std::string::npos)
      message.erase(0, address + 3);
    else if (line != std::string::npos)
      message.erase(0, line + 1);
    message.erase(message.find_last_not_of(" \n") + 1);
    std::replace(message.begin(), message.end(), '\n', ' ');
    return message;
  }
};
vtkStandardNewMacro(FirstError)

    template<class Action>
    void run_quietly(const Action& action) {
  const vtkNew<FirstError> error;
  vtkOutputWindow::SetInstance(error);
  vtkLogger::SetStderrVerbosity(vtkLogger::VERBOSITY_OFF);
  vtkSMPTools::SetBackend("Sequential"); // confined processes may not start threads
  action();
  if (!error->text.empty()) refuse(error->text);
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

std::string write_unstructured_grid(const Mesh& mesh, const GridFields& fields) {
  return write(*grid_of(mesh), fields);
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

/// The number of triangles that a binary file says that it has.
std::uint32_t stated_triangles(const std::string& path) {
  std::uint32_t count = 0;
  std::ifstream file(path, std::ios::binary);
  file.seekg(80).read(reinterpret_cast<char*>(&count), sizeof count);
  return count;
}

/// @return the triangles of a reader of polygons
template<class Reader>
Surface read_by(const std::string& path) {
  const vtkNew<Reader> reader;
  reader->SetFileName(path.c_str());
  run(*reader);
  return triangles_in(*reader->GetOutput());
}

Surface read_triangles(const std::string& path) {
  const std::string ending = std::filesystem::path(path).extension().string();
  if (ending == ".obj") return read_by<vtkOBJReader>(path);
  if (ending == ".ply") return read_by<vtkPLYReader>(path);
  if (ending == ".vtp") return read_by<vtkXMLPolyDataReader>(path);
  constexpr std::uintmax_t head = 84, per_triangle = 50; // bytes of a binary file
  vtkNew<vtkSTLReader> reader;
  reader->SetFileName(path.c_str());
  reader->MergingOff(); // merging must not see a position that is not finite
  run(*reader);
  vtkPolyData& body = *reader->GetOutput();
  Surface surface(static_cast<std::size_t>(body.GetNumberOfPolys()));
  if (reader->GetBinaryHeader()) { // VTK goes on to the end of the file
    const std::uint32_t stated = stated_triangles(path);
    if (stated > surface.size() && (std::filesystem::file_size(path) - head) % per_triangle != 0)
      refuse(path + " ends within a triangle");
    if (stated == 0 || stated > surface.size())
      refuse(path + " has " + std::to_string(surface.size()) + " triangles, and says that it has " +
             std::to_string(stated));
    surface.resize(stated);
  }
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

void run(vtkAlgorithm& algorithm) {
  run_quietly([&] { algorithm.Update(); });
}

void run_information(vtkAlgorithm& algorithm) {
  run_quietly([&] { algorithm.UpdateInformation(); });
}

extern "C" const VtkFunctions springproof_vtk{
    write_unstructured_grid, write_lines,       read_points,   read_cells,     read_mesh_cells,
    read_triangles,          nearest_points,    read_volume,   read_placement, contour_of,
    nearest_in_cells,        decimated_surface, distances_from};

} // namespace springproof::cases
