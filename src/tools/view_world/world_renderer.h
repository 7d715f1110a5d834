// Pictures of shapes by VTK, off-screen.
#pragma once

#include <memory>
#include <vector>

#include "drawn_shape.h"
#include "picture.h"
#include "view_camera.h"
#include "world_frames.h"

namespace blem_sim {

class WorldRenderer {
 public:
  /** Needs a display (VirtualDisplay). @param up unit, upwards in the pictures */
  WorldRenderer(const std::vector<DrawnShape>& shapes, const ViewCamera& camera, const Vector3& up, const PictureSize& size);
  ~WorldRenderer();
  WorldRenderer(const WorldRenderer&) = delete;
  WorldRenderer& operator=(const WorldRenderer&) = delete;

  /** @param before_all drawn before everything else, whatever hides it @throws std::runtime_error without OpenGL */
  Picture draw(const WorldFrame& frame, const DrawnShape& before_all);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace blem_sim
