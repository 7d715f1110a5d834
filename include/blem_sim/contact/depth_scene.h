// The colliders of a world as a depth camera sees them.
#pragma once

#include <vector>

#include "blem_sim/contact/ray_scene.h"

namespace blem_sim::contact {

/** [pixels] A camera without distortion; whole numbers are the middles of pixels. */
struct Pinhole {
  int width, height;
  double focal_length, middle_u, middle_v;
};

/** The ray through each pixel of a camera that looks along x of its frame S; z is up. */
struct PinholeRays {
  Pinhole pinhole;
  Pose X_WS = Pose::Identity();

  /** In the world, one metre along x of S. */
  Vector3 direction(int row, int column) const;
};

/**
 * Depths of many targets, each that of RayScene::firstHits, bit for bit. Triangles are drawn, which takes a fraction of the time of rays
 * that look for them; other elements and half-spaces are met by rays. Any number of threads may ask at a time.
 */
class DepthScene {
 public:
  explicit DepthScene(std::vector<RayTarget> targets);

  static constexpr int BAND_ROWS = 16;
  /**
   * Draws a band of an image.
   * @param band its rows are BAND_ROWS * band and those below, as far as the image goes
   * @param depths [m] of the band, row by row: along x of S, infinity where nothing is met within the query's range
   */
  void drawBand(const PinholeRays& rays, const RayScene::Query& query, int band, double* depths) const;

 private:
  std::vector<RayTarget> meshes_;  // of triangles alone
  std::vector<Pose> X_CW_;         // of each mesh
  std::vector<double> slacks_;     // [m] of each mesh: rounding of a place in it
  RayScene others_;
  bool has_others_;
};

}  // namespace blem_sim::contact
