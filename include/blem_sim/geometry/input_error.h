#pragma once

#include <stdexcept>
#include <string>

namespace blem_sim {

/** Bad input: a file, a URDF, a parameter, a message. The text is one line that names the file, the field and the cure.
 *  Thrown only at the door (load, configuration, command), never by a step. */
class InputError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

}  // namespace blem_sim
