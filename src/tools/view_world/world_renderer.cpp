#include "world_renderer.h"

#include <vtkActor.h>
#include <vtkAutoInit.h>
#include <vtkCamera.h>
#include <vtkCellArray.h>
#include <vtkFloatArray.h>
#include <vtkImageData.h>
#include <vtkLight.h>
#include <vtkMatrix4x4.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkPolyDataMapper.h>
#include <vtkProperty.h>
#include <vtkRenderWindow.h>
#include <vtkRenderer.h>
#include <vtkSmartPointer.h>
#include <vtkUnsignedCharArray.h>
#include <vtkVersionMacros.h>
#include <vtkWindowToImageFilter.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "surface_normals.h"

VTK_MODULE_INIT(vtkRenderingOpenGL2)

namespace blem_sim {

namespace {

constexpr int FINER = 2;              // pixels drawn for one of the picture, each way
constexpr double NEAREST = 0.02;      // of the way to the target: nearer things are cut off
constexpr double FARTHEST = 1000;     // ways to the target
constexpr double SMALLEST_DOT = 1.0;  // [drawn pixels]

const double ABOVE[3] = {0.86, 0.91, 0.96}, BELOW[3] = {0.55, 0.63, 0.72};  // background

vtkSmartPointer<vtkUnsignedCharArray> makeColours() {
  auto colours = vtkSmartPointer<vtkUnsignedCharArray>::New();
  colours->SetNumberOfComponents(3);
  return colours;
}

void addColour(const sim::Colour& colour, vtkUnsignedCharArray* colours) {
  for (const float part : {colour.r, colour.g, colour.b}) colours->InsertNextValue(static_cast<unsigned char>(std::lround(255 * part)));
}

/** Corners of triangles, each with its normal and colour. */
vtkSmartPointer<vtkPolyData> triangleData(const DrawnShape& shape) {
  const std::vector<Vector3> normals = cornerNormals(shape.mesh);
  vtkNew<vtkPoints> points;
  vtkNew<vtkFloatArray> directions;
  directions->SetNumberOfComponents(3);
  vtkNew<vtkCellArray> cells;
  const vtkSmartPointer<vtkUnsignedCharArray> colours = makeColours();
  for (std::size_t i = 0; i < shape.mesh.elements.size(); ++i) {
    cells->InsertNextCell(3);
    for (int corner = 0; corner < 3; ++corner) {
      cells->InsertCellPoint(points->InsertNextPoint(shape.mesh.vertices[shape.mesh.elements[i][corner]].data()));
      directions->InsertNextTuple(normals[3 * i + corner].data());
      addColour(shape.colours.empty() ? shape.colour : shape.colours[i], colours);
    }
  }
  auto data = vtkSmartPointer<vtkPolyData>::New();
  data->SetPoints(points.GetPointer());
  data->SetPolys(cells.GetPointer());
  data->GetPointData()->SetNormals(directions.GetPointer());
  data->GetPointData()->SetScalars(colours);
  return data;
}

vtkSmartPointer<vtkPolyData> dotData(const DrawnShape& shape) {
  vtkNew<vtkPoints> points;
  vtkNew<vtkCellArray> cells;
  const vtkSmartPointer<vtkUnsignedCharArray> colours = makeColours();
  for (std::size_t i = 0; i < shape.dots.size(); ++i) {
    cells->InsertNextCell(1);
    cells->InsertCellPoint(points->InsertNextPoint(shape.dots[i].data()));
    addColour(shape.colours.empty() ? shape.colour : shape.colours[i], colours);
  }
  auto data = vtkSmartPointer<vtkPolyData>::New();
  data->SetPoints(points.GetPointer());
  data->SetVerts(cells.GetPointer());
  data->GetPointData()->SetScalars(colours);
  return data;
}

vtkSmartPointer<vtkActor> actorOf(vtkPolyData* data) {
  vtkNew<vtkPolyDataMapper> mapper;
  mapper->SetInputData(data);
#if VTK_MAJOR_VERSION < 9
  mapper->SetScalarMaterialModeToAmbientAndDiffuse();  // later ones always do
#endif
  auto actor = vtkSmartPointer<vtkActor>::New();
  actor->SetMapper(mapper.GetPointer());
  return actor;
}

vtkSmartPointer<vtkActor> triangleActor(const DrawnShape& shape) {
  const vtkSmartPointer<vtkActor> actor = actorOf(triangleData(shape));
  vtkProperty* property = actor->GetProperty();
  property->SetAmbient(0.35);
  property->SetDiffuse(0.75);
  property->SetSpecular(0.06);
  property->SetSpecularPower(30);
  property->SetOpacity(shape.opacity);
  return actor;
}

/** @param pixels that a metre has at the target */
vtkSmartPointer<vtkActor> dotActor(const DrawnShape& shape, double pixels) {
  const vtkSmartPointer<vtkActor> actor = actorOf(dotData(shape));
  actor->GetProperty()->LightingOff();
  actor->GetProperty()->SetPointSize(static_cast<float>(std::max(SMALLEST_DOT, pixels * shape.dot_size)));
  return actor;
}

vtkSmartPointer<vtkMatrix4x4> matrixOf(const Pose& pose) {
  auto matrix = vtkSmartPointer<vtkMatrix4x4>::New();
  for (int row = 0; row < 4; ++row)
    for (int column = 0; column < 4; ++column) matrix->SetElement(row, column, pose.matrix()(row, column));
  return matrix;
}

/** Lights from above, before and behind the camera, whose right is +x here and whose upward is +y. */
void addLights(vtkRenderer* renderer) {
  const struct { double x, y, z, intensity; } LIGHTS[] = {{-0.5, 1.0, 0.8, 0.55}, {0.4, 0.1, 1.0, 0.45}};
  renderer->RemoveAllLights();
  renderer->AutomaticLightCreationOff();
  for (const auto& from : LIGHTS) {
    vtkNew<vtkLight> light;
    light->SetLightTypeToCameraLight();
    light->SetPosition(from.x, from.y, from.z);
    light->SetFocalPoint(0, 0, 0);
    light->SetIntensity(from.intensity);
    renderer->AddLight(light.GetPointer());
  }
}

/** Another direction where the camera looks straight up or down. */
Vector3 upInPicture(const ViewCamera& camera, const Vector3& up) {
  const Vector3 along = (camera.target - camera.eye).normalized();
  return along.cross(up).norm() > 1e-3 ? up : Vector3(std::abs(up.x()) < 0.9 ? Vector3::UnitX() : Vector3::UnitY());
}

}  // namespace

struct WorldRenderer::Impl {
  struct Placed {
    int body;
    vtkSmartPointer<vtkActor> actor;
  };

  vtkNew<vtkRenderWindow> window;
  vtkNew<vtkRenderer> world, before_all;
  vtkNew<vtkCamera> camera;
  std::vector<Placed> placed;
  PictureSize size;

  void place(vtkSmartPointer<vtkActor> actor, int body) {
    world->AddActor(actor);
    placed.push_back({body, actor});
  }
  Picture shoot();
};

WorldRenderer::WorldRenderer(const std::vector<DrawnShape>& shapes, const ViewCamera& camera, const Vector3& up, const PictureSize& size)
    : impl_(std::make_unique<Impl>()) {
  impl_->size = {FINER * size.width, FINER * size.height};
  const double way = (camera.target - camera.eye).norm();
  const Vector3 view_up = upInPicture(camera, up);
  impl_->camera->SetPosition(camera.eye.x(), camera.eye.y(), camera.eye.z());
  impl_->camera->SetFocalPoint(camera.target.x(), camera.target.y(), camera.target.z());
  impl_->camera->SetViewUp(view_up.x(), view_up.y(), view_up.z());
  impl_->camera->SetViewAngle(FIELD_OF_VIEW * 180 / M_PI);
  impl_->camera->SetClippingRange(NEAREST * way, FARTHEST * way);

  impl_->window->SetOffScreenRendering(1);
  impl_->window->SetMultiSamples(0);
  impl_->window->SetSize(impl_->size.width, impl_->size.height);
  impl_->window->SetNumberOfLayers(2);
  impl_->before_all->SetLayer(1);
  impl_->world->GradientBackgroundOn();
  impl_->world->SetBackground(BELOW[0], BELOW[1], BELOW[2]);
  impl_->world->SetBackground2(ABOVE[0], ABOVE[1], ABOVE[2]);
  for (vtkRenderer* renderer : {impl_->world.GetPointer(), impl_->before_all.GetPointer()}) {
    renderer->SetActiveCamera(impl_->camera.GetPointer());
    addLights(renderer);
    impl_->window->AddRenderer(renderer);
  }
  const double pixels = 0.5 * impl_->size.height / std::tan(0.5 * FIELD_OF_VIEW) / way;
  for (const DrawnShape& shape : shapes) {
    if (!shape.mesh.elements.empty()) impl_->place(triangleActor(shape), shape.body);
    if (!shape.dots.empty()) impl_->place(dotActor(shape, pixels), shape.body);
  }
}

WorldRenderer::~WorldRenderer() = default;

Picture WorldRenderer::draw(const WorldFrame& frame, const DrawnShape& before_all) {
  for (const Impl::Placed& placed : impl_->placed) {
    if (placed.body != dynamics::WORLD_BODY) placed.actor->SetUserMatrix(matrixOf(frame.bodies[placed.body].X_WB));
  }
  impl_->before_all->RemoveAllViewProps();
  if (!before_all.mesh.elements.empty()) impl_->before_all->AddActor(triangleActor(before_all));
  return halved(impl_->shoot());
}

Picture WorldRenderer::Impl::shoot() {
  window->Render();
  vtkNew<vtkWindowToImageFilter> shutter;
  shutter->SetInput(window.GetPointer());
  shutter->SetInputBufferTypeToRGB();
  shutter->ReadFrontBufferOff();
  shutter->ShouldRerenderOff();
  shutter->Update();
  vtkImageData* image = shutter->GetOutput();
  const int* drawn = image->GetDimensions();
  if (drawn[0] != size.width || drawn[1] != size.height) throw std::runtime_error("OpenGL draws no picture of this size");
  const auto* pixels = static_cast<const std::uint8_t*>(image->GetScalarPointer());
  return {size,
          std::vector<std::uint8_t>(pixels, pixels + 3 * static_cast<std::size_t>(size.width) * static_cast<std::size_t>(size.height))};
}

}  // namespace blem_sim
