// The rows of a PLY file.
#pragma once

#include <string>

#include "ply/ply_header.h"
#include "soup/surface_soup.h"

namespace blem_sim::model {

/**
 * Vertices, as precise as the file has them, with the faces and strips of triangles of a binary PLY.
 * @throws InputError: too short for the rows that its header announces, a face of vertices that are not there
 */
SurfaceSoup readBinaryPly(const std::string& file, const std::string& bytes, const PlyHeader& header);

/** Refuses an ASCII PLY with fewer rows or numbers than its header announces. */
void checkAsciiPly(const std::string& file, const std::string& bytes, const PlyHeader& header);

}  // namespace blem_sim::model
