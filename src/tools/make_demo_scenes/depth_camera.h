// A virtual depth camera of the structured-light kind.
#pragma once

#include <optional>
#include <vector>

#include "blem_sim/geometry/bvh.h"
#include "noise.h"

namespace blem_sim::demo {

/** A round spot that swallows infrared light: a puddle, a dark mark. */
struct DarkSpot {
  Vector3 centre;  ///< [m] world
  double radius;   ///< [m]
};

/** A mesh with its tree, and the spots of it that a camera does not see. */
struct Scene {
  Scene(geometry::TriangleMesh triangles, std::vector<DarkSpot> spots)
      : mesh(std::move(triangles)), bvh(mesh), dark_spots(std::move(spots)) {}
  geometry::TriangleMesh mesh;
  geometry::Bvh bvh;
  std::vector<DarkSpot> dark_spots;
};

struct DepthCamera {
  Pose X_WC;  ///< camera in the world; z looks forward, x right, y down
  int width = 640, height = 480;
  int stride = 4;             ///< pixels binned to one sample, each way
  double focal_length = 580;  ///< [pixels]
  double baseline = 0.075;    ///< [m] from the camera to the infrared projector, along x
  int frames = 30;            ///< averaged
};

/** Camera at `eye` that looks at `target`, world z up. */
Pose lookAt(const Vector3& eye, const Vector3& target);

/** Samples row by row; empty where nothing came back. */
struct DepthImage {
  int columns = 0, rows = 0;
  std::vector<std::optional<Vector3>> points;  ///< [m] world
};

/**
 * Image of the camera: rays to the nearest surface; nothing where the projector's light does not reach, on dark spots, grazing or too
 * far surfaces, and now and then at random; each frame's depth with the noise of such cameras, sigma = 0.0012 + 0.0019 (z - 0.4)^2 m
 * [Nguyen 2012], its disparity in steps of 1/8 pixel; frames averaged.
 */
DepthImage capture(const Scene& scene, const DepthCamera& camera, Noise& noise);

/** Joins neighbouring samples to triangles unless their depths jump. @param max_edge [m] */
geometry::TriangleMesh triangulated(const DepthImage& image, double max_edge);

}  // namespace blem_sim::demo
