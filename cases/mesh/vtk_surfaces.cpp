#include "cases/mesh/vtk_parts.hpp"

#include <algorithm>
#include <cmath>
#include <vtkCellArray.h>
#include <vtkFloatArray.h>
#include <vtkFlyingEdges3D.h>
#include <vtkGenericCell.h>
#include <vtkImageData.h>
#include <vtkImplicitPolyDataDistance.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkPolyDataConnectivityFilter.h>
#include <vtkQuadricDecimation.h>
#include <vtkSmartPointer.h>
#include <vtkStaticCellLocator.h>
#include <vtkTriangleFilter.h>
#include <vtkUnstructuredGrid.h>
#include <vtkWindowedSincPolyDataFilter.h>

namespace springproof::cases {

namespace {

using Eigen::Vector3d;

/// VTK's filters take the numbers of points as they are.
void check_points_exist(vtkCellArray& cells, vtkIdType n_points) {
  const vtkNew<vtkIdList> corners;
  for (cells.InitTraversal(); cells.GetNextCell(corners) != 0;)
    for (vtkIdType c = 0; c < corners->GetNumberOfIds(); ++c)
      if (corners->GetId(c) < 0 || corners->GetId(c) >= n_points)
        refuse("has a polygon of a point that does not exist");
}

/// The triangles alone.
Surface triangles_of(vtkPolyData& data) {
  Surface surface;
  vtkCellArray& polygons = *data.GetPolys();
  const vtkNew<vtkIdList> corners;
  for (polygons.InitTraversal(); polygons.GetNextCell(corners) != 0;) {
    if (corners->GetNumberOfIds() != 3) continue;
    surface.emplace_back();
    for (vtkIdType c = 0; c < 3; ++c)
      data.GetPoint(corners->GetId(c), surface.back()[static_cast<std::size_t>(c)].data());
  }
  return surface;
}

/// The picture with one more point at each side, whose value is below the level.
vtkNew<vtkImageData> with_border(const Picture& picture, double level) {
  vtkNew<vtkImageData> image;
  const auto& n = picture.n_points;
  image->SetDimensions(n[0] + 2, n[1] + 2, n[2] + 2);
  image->SetSpacing(picture.spacing.data());
  image->SetOrigin(Vector3d(picture.origin - picture.spacing).data());
  image->AllocateScalars(VTK_FLOAT, 1);
  auto* const values = static_cast<float*>(image->GetScalarPointer());
  const float below = std::min(static_cast<float>(2 * level) - picture.largest(),
                               *std::min_element(picture.values.begin(), picture.values.end()));
  std::fill_n(values, image->GetNumberOfPoints(), below);
  const std::size_t row = index(n[0]) + 2, layer = row * (index(n[1]) + 2);
  for (std::size_t k = 0; k < index(n[2]); ++k)
    for (std::size_t j = 0; j < index(n[1]); ++j)
      std::copy_n(&picture.values[(k * index(n[1]) + j) * index(n[0])], n[0],
                  values + (k + 1) * layer + (j + 1) * row + 1);
  return image;
}

/// Reduces a surface with more triangles to about so many.
vtkSmartPointer<vtkPolyData> with_fewer_triangles(vtkPolyData& surface, std::size_t n_triangles) {
  const auto has = static_cast<double>(surface.GetNumberOfPolys()), wanted = static_cast<double>(n_triangles);
  if (!(wanted < has)) return &surface;
  const vtkNew<vtkQuadricDecimation> decimation;
  decimation->SetInputData(&surface);
  decimation->SetTargetReduction(1 - wanted / has);
  decimation->VolumePreservationOn();
  decimation->SetAttributeErrorMetric(surface.GetPointData()->GetVectors() != nullptr);
  run(*decimation);
  return decimation->GetOutput();
}

vtkNew<vtkPolyData> polygons_of(const TriangleMesh& surface) {
  const vtkNew<vtkPoints> points;
  points->SetDataTypeToDouble();
  for (const Vector3d& vertex : surface.vertices) points->InsertNextPoint(vertex.data());
  const vtkNew<vtkCellArray> triangles;
  for (const auto& [a, b, c] : surface.triangles) triangles->InsertNextCell({a, b, c});
  vtkNew<vtkPolyData> data;
  data->SetPoints(points);
  data->SetPolys(triangles);
  return data;
}

double enclosed_volume(const Surface& surface) {
  double volume = 0;
  for (const auto& [a, b, c] : surface) volume += a.dot(b.cross(c)) / 6;
  return volume;
}

} // namespace

Surface triangles_in(vtkPolyData& data) {
  check_points_exist(*data.GetPolys(), data.GetNumberOfPoints());
  check_points_exist(*data.GetStrips(), data.GetNumberOfPoints());
  const vtkNew<vtkTriangleFilter> triangles;
  triangles->SetInputData(&data);
  triangles->PassVertsOff();
  triangles->PassLinesOff();
  run(*triangles);
  return triangles_of(*triangles->GetOutput());
}

Surface contour_of(const Picture& picture, const ContourSettings& settings) {
  const vtkNew<vtkFlyingEdges3D> edges;
  edges->SetInputData(with_border(picture, settings.level));
  edges->SetValue(0, settings.level);
  edges->ComputeNormalsOff();
  edges->ComputeScalarsOff();
  run(*edges);
  vtkSmartPointer<vtkPolyData> surface = edges->GetOutput();
  if (settings.has_one_piece && surface->GetNumberOfPolys() > 0) {
    const vtkNew<vtkPolyDataConnectivityFilter> pieces;
    pieces->SetInputData(surface);
    pieces->SetExtractionModeToLargestRegion();
    run(*pieces);
    surface = pieces->GetOutput();
  }
  if (settings.n_smoothing > 0) {
    const vtkNew<vtkWindowedSincPolyDataFilter> smooth;
    smooth->SetInputData(surface);
    smooth->SetNumberOfIterations(settings.n_smoothing);
    smooth->SetPassBand(0.1);
    smooth->NormalizeCoordinatesOn();
    smooth->NonManifoldSmoothingOn();
    run(*smooth);
    surface = smooth->GetOutput();
  }
  if (settings.n_triangles > 0) surface = with_fewer_triangles(*surface, settings.n_triangles);
  Surface triangles = triangles_of(*surface);
  if (enclosed_volume(triangles) < 0)
    for (auto& triangle : triangles) std::swap(triangle[1], triangle[2]);
  return triangles;
}

std::vector<double> distances_from(const TriangleMesh& surface, const std::vector<Vector3d>& points) {
  const vtkNew<vtkImplicitPolyDataDistance> distance;
  distance->SetInput(polygons_of(surface));
  std::vector<double> distances;
  for (Vector3d point : points) distances.push_back(distance->EvaluateFunction(point.data()));
  return distances;
}

Surface decimated_surface(const TriangleMesh& surface, std::size_t n_triangles) {
  // A flat face needs triangles too, to be able to bend. So the vertices get a field that bends everywhere,
  // which the triangles left must interpolate.
  const vtkNew<vtkFloatArray> bent;
  bent->SetNumberOfComponents(3);
  const Eigen::AlignedBox3d box = bounding_box(surface.vertices);
  for (const Vector3d& vertex : surface.vertices) {
    const Vector3d from_centre = vertex - box.center();
    bent->InsertNextTuple(Vector3d(from_centre.cwiseAbs2() / box.diagonal().norm()).data());
  }
  const vtkNew<vtkPolyData> data = polygons_of(surface);
  data->GetPointData()->SetVectors(bent);
  return triangles_of(*with_fewer_triangles(*data, n_triangles));
}

std::vector<PlaceInCell> nearest_in_cells(const Mesh& mesh, const std::vector<Vector3d>& positions) {
  const vtkNew<vtkUnstructuredGrid> grid = grid_of(mesh);
  const vtkNew<vtkStaticCellLocator> locator;
  locator->SetDataSet(grid);
  locator->BuildLocator();
  const vtkNew<vtkGenericCell> cell;
  std::array<double, 8> weights;
  std::vector<PlaceInCell> places;
  for (Vector3d position : positions) {
    Vector3d local, nearest = position;
    vtkIdType found = locator->FindCell(position.data(), 0, cell, local.data(), weights.data());
    if (found < 0) {
      int part = 0;
      double squared = 0;
      locator->FindClosestPoint(position.data(), nearest.data(), cell, found, part, squared);
    }
    if (found < 0) refuse("a vertex of the surface has no nearest cell");
    places.push_back({static_cast<std::size_t>(found), nearest});
  }
  return places;
}

} // namespace springproof::cases
