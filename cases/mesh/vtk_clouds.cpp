#include "cases/mesh/vtk_parts.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>
#include <vtkCellData.h>
#include <vtkDataSetReader.h>
#include <vtkGenericCell.h>
#include <vtkImageData.h>
#include <vtkPointData.h>
#include <vtkRectilinearGrid.h>
#include <vtkSmartPointer.h>
#include <vtkStaticCellLocator.h>
#include <vtkXMLImageDataReader.h>
#include <vtkXMLPolyDataReader.h>
#include <vtkXMLRectilinearGridReader.h>
#include <vtkXMLStructuredGridReader.h>
#include <vtkXMLUnstructuredGridReader.h>

namespace springproof::cases {

namespace {

using Eigen::Vector3d;

DataSet read_legacy(const std::string& content) {
  if (content.size() > std::numeric_limits<int>::max()) refuse("a legacy file may have up to 2 GB");
  const vtkNew<vtkDataSetReader> reader;
  reader->ReadFromInputStringOn();
  reader->SetBinaryInputString(content.data(), static_cast<int>(content.size()));
  if (reader->ReadOutputType() < 0)
    refuse("its data set is none of UNSTRUCTURED_GRID, POLYDATA, STRUCTURED_GRID, RECTILINEAR_GRID, "
           "STRUCTURED_POINTS");
  reader->ReadAllScalarsOn();
  reader->ReadAllVectorsOn();
  reader->ReadAllFieldsOn();
  run(*reader);
  return vtkDataSet::SafeDownCast(reader->GetOutputDataObject(0));
}

/// The type that an XML file states; empty if it is no such file.
std::string xml_type(const std::string& content) {
  const std::size_t tag = content.find("<VTKFile"), end = content.find('>', tag);
  if (tag == std::string::npos || end == std::string::npos) return "";
  const std::string attributes = content.substr(tag, end - tag);
  const std::size_t type = attributes.find("type=");
  if (type == std::string::npos || type + 6 > attributes.size()) return "";
  const std::size_t begin = type + 6, quote = attributes.find(attributes[type + 5], begin);
  return quote == std::string::npos ? "" : attributes.substr(begin, quote - begin);
}

std::vector<Vector3d> vectors_of(vtkDataArray& array) {
  std::vector<Vector3d> vectors(static_cast<std::size_t>(array.GetNumberOfTuples()));
  for (std::size_t p = 0; p < vectors.size(); ++p)
    array.GetTuple(static_cast<vtkIdType>(p), vectors[p].data());
  return vectors;
}

bool is_single_precision(vtkDataSet& data) {
  if (auto* const points = vtkPointSet::SafeDownCast(&data))
    return points->GetPoints()->GetDataType() == VTK_FLOAT;
  if (auto* const grid = vtkRectilinearGrid::SafeDownCast(&data)) {
    vtkDataArray* const coordinates[] = {grid->GetXCoordinates(), grid->GetYCoordinates(),
                                         grid->GetZCoordinates()};
    return std::any_of(std::begin(coordinates), std::end(coordinates),
                       [](vtkDataArray* along) { return along->GetDataType() == VTK_FLOAT; });
  }
  return true;
}

PointCloud cloud_of(vtkDataSet& data) {
  PointCloud cloud;
  cloud.is_single_precision = is_single_precision(data);
  for (vtkIdType p = 0; p < data.GetNumberOfPoints(); ++p)
    data.GetPoint(p, cloud.points.emplace_back().data());
  for (int a = 0; a < data.GetPointData()->GetNumberOfArrays(); ++a) {
    vtkAbstractArray* const any = data.GetPointData()->GetAbstractArray(a);
    const std::string name = any->GetName() ? any->GetName() : "";
    vtkDataArray* const array = vtkDataArray::SafeDownCast(any); // null: texts
    const int n = any->GetNumberOfComponents();
    const bool is_real = array && (array->GetDataType() == VTK_FLOAT || array->GetDataType() == VTK_DOUBLE);
    if (is_real && n == 3)
      cloud.fields.push_back({name, vectors_of(*array)});
    else if (n != 3)
      cloud.others.push_back("'" + name + "' of " + std::to_string(n) +
                             (n == 1 ? " component" : " components"));
    else
      cloud.others.push_back("'" + name + "' of type " + any->GetDataTypeAsString());
  }
  for (int a = 0; a < data.GetCellData()->GetNumberOfArrays(); ++a)
    if (const char* const name = data.GetCellData()->GetArrayName(a))
      cloud.others.push_back("'" + std::string(name) + "' of cells");
  return cloud;
}

/// Kinds of cells that interpolate between their points.
constexpr int interpolating[] = {VTK_TETRA,
                                 VTK_VOXEL,
                                 VTK_HEXAHEDRON,
                                 VTK_WEDGE,
                                 VTK_PYRAMID,
                                 VTK_QUADRATIC_TETRA,
                                 VTK_QUADRATIC_WEDGE,
                                 VTK_QUADRATIC_PYRAMID,
                                 VTK_QUADRATIC_HEXAHEDRON,
                                 VTK_TRIQUADRATIC_HEXAHEDRON};

/// The cells of a volume, without the surfaces, lines and points beside them. Those of an image become
/// hexahedra: VTK finds nothing in voxels that are turned by the image's direction.
vtkNew<vtkUnstructuredGrid> volume_of(vtkDataSet& data, const PointCloud& cloud) {
  vtkNew<vtkUnstructuredGrid> volume = grid_of(cloud.points);
  volume->AllocateEstimate(data.GetNumberOfCells(), 8);
  const vtkNew<vtkGenericCell> cell;
  for (vtkIdType c = 0; c < data.GetNumberOfCells(); ++c) {
    data.GetCell(c, cell);
    if (cell->GetCellDimension() < 3) continue;
    if (std::count(std::begin(interpolating), std::end(interpolating), cell->GetCellType()) == 0)
      refuse("has cells of VTK's type " + std::to_string(cell->GetCellType()) +
             ", which nothing interpolates in; allowed are linear and quadratic tetrahedra, hexahedra, "
             "wedges, pyramids, "
             "and voxels");
    if (cell->GetCellType() == VTK_VOXEL) {
      std::array<vtkIdType, 8> points;
      for (std::size_t v = 0; v < 8; ++v) points[v] = cell->GetPointId(static_cast<int>(around_cell[v]));
      volume->InsertNextCell(VTK_HEXAHEDRON, 8, points.data());
    } else {
      volume->InsertNextCell(cell->GetCellType(), cell->PointIds);
    }
  }
  if (volume->GetNumberOfCells() == 0)
    refuse("has no cells of a volume that values inside could be interpolated in");
  return volume;
}

enum class Outside { anywhere, near_the_cells };

/// VTK ends its search for a place in a curved cell 1e-3 of its size beside it: Newton's method goes on.
void improve(vtkGenericCell& cell, const Vector3d& position, Vector3d& local, std::vector<double>& weights) {
  const int n = static_cast<int>(cell.GetNumberOfPoints());
  std::vector<double> derivatives(index(3 * n));
  double missed_before = std::numeric_limits<double>::infinity();
  Vector3d best = local;
  for (int step = 0; step < 8; ++step) {
    cell.InterpolateFunctions(local.data(), weights.data());
    cell.InterpolateDerivs(local.data(), derivatives.data());
    Vector3d missing = position;
    Eigen::Matrix3d jacobian = Eigen::Matrix3d::Zero();
    for (int v = 0; v < n; ++v) {
      Vector3d point;
      cell.GetPoints()->GetPoint(v, point.data());
      missing -= weights[index(v)] * point;
      for (int a = 0; a < 3; ++a) jacobian.col(a) += derivatives[index(a * n + v)] * point;
    }
    if (!(missing.norm() < missed_before)) break;
    missed_before = missing.norm();
    best = local;
    local += jacobian.partialPivLu().solve(missing);
  }
  local = best;
  cell.InterpolateFunctions(local.data(), weights.data());
}

Interpolation interpolation(vtkUnstructuredGrid& cells, const std::vector<Vector3d>& positions,
                            Outside allowed) {
  const vtkNew<vtkStaticCellLocator> locator;
  locator->SetDataSet(&cells);
  locator->BuildLocator();
  const vtkNew<vtkGenericCell> cell;
  std::vector<double> weights(static_cast<std::size_t>(cells.GetMaxCellSize()));
  Interpolation result;
  result.first.push_back(0);
  for (const Vector3d& position : positions) {
    Vector3d at = position, local;
    double distance_squared = 0;
    if (locator->FindCell(at.data(), 0, cell, local.data(), weights.data()) < 0) {
      vtkIdType closest = -1;
      int part = 0;
      locator->FindClosestPoint(position.data(), at.data(), cell, closest, part, distance_squared);
      double ignored = 0;
      if (closest < 0 ||
          cell->EvaluatePosition(at.data(), nullptr, part, local.data(), ignored, weights.data()) < 0)
        refuse("has no cell close to a node of the case's mesh");
      if (const double size = 0.5 * std::sqrt(cell->GetLength2());
          allowed == Outside::near_the_cells && !(distance_squared <= size * size))
        refuse("has no cell at (" + std::to_string(position.x()) + ", " + std::to_string(position.y()) +
               ", " + std::to_string(position.z()) + ") mm, a node of the case's mesh: the closest is " +
               std::to_string(std::sqrt(distance_squared)) + " mm away, more than half of its diagonal");
    }
    improve(*cell, at, local, weights);
    for (vtkIdType v = 0; v < cell->GetNumberOfPoints(); ++v) {
      result.points.push_back(static_cast<int>(cell->GetPointId(static_cast<int>(v))));
      result.weights.push_back(weights[static_cast<std::size_t>(v)]);
    }
    result.first.push_back(result.points.size());
    result.outside.push_back(std::sqrt(distance_squared));
  }
  return result;
}

} // namespace

DataSet read_data_set(const std::string& content) {
  struct Type {
    const char* name;
    DataSet (*read)(const std::string&);
  };
  static constexpr Type types[] = {{"UnstructuredGrid", read_xml<vtkXMLUnstructuredGridReader>},
                                   {"PolyData", read_xml<vtkXMLPolyDataReader>},
                                   {"StructuredGrid", read_xml<vtkXMLStructuredGridReader>},
                                   {"RectilinearGrid", read_xml<vtkXMLRectilinearGridReader>},
                                   {"ImageData", read_xml<vtkXMLImageDataReader>}};
  DataSet data;
  if (content.rfind("# vtk DataFile", 0) == 0) {
    data = read_legacy(content);
  } else {
    const std::string type = xml_type(content);
    const auto found = std::find_if(std::begin(types), std::end(types),
                                    [&](const Type& known) { return known.name == type; });
    if (type.empty()) refuse("it has neither the first line of a .vtk file nor a tag <VTKFile type=...>");
    if (found == std::end(types))
      refuse("its type is " + type +
             ", must be UnstructuredGrid, PolyData, StructuredGrid, RectilinearGrid or ImageData; of a file "
             "that names "
             "others, give one that holds all of them");
    data = found->read(content);
  }
  if (!data || data->GetNumberOfPoints() == 0) refuse("it has no points");
  return data;
}

PointCloud read_points(const std::string& content) {
  return cloud_of(*read_data_set(content));
}

CellCloud read_cells(const std::string& content, const Mesh& mesh) {
  const DataSet data = read_data_set(content);
  CellCloud result{cloud_of(*data), {}, {}};
  for (const Vector3d& point : result.cloud.points)
    if (!point.allFinite()) refuse("has a point that is not finite");
  result.to_nodes =
      interpolation(*volume_of(*data, result.cloud), mesh.nodes.to_vector(), Outside::near_the_cells);
  result.from_nodes = interpolation(*grid_of(mesh), result.cloud.points, Outside::anywhere);
  return result;
}

} // namespace springproof::cases
