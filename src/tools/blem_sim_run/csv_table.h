// --csv: joints, free bodies and sensors over time, one row per sampling instant.
#pragma once

#include <fstream>
#include <string>
#include <vector>

#include "blem_sim/sim/simulator.h"
#include "last_readings.h"

namespace blem_sim {

/**
 * Columns: time; per movable joint MODEL::JOINT, _vel, _effort, _desired; per free robot or object the pose of its first body, _x _y _z
 * _qx _qy _qz _qw; per sensor its fields, empty until its first reading, the last reading in between.
 */
class CsvTable {
 public:
  /** @param rate [Hz], 0 = every step @throws InputError if the file cannot be written */
  CsvTable(const sim::Simulator& simulator, const std::string& file, double rate);
  void add(const sim::StepReport& report);
  /** Ends the file. @throws InputError if rows are not in it */
  void close();

 private:
  void writeHeader();
  void writeRow(const sim::StepReport& report);

  const sim::Simulator& simulator_;
  std::string file_;
  std::ofstream stream_;
  double rate_ = 0;
  LastReadings readings_;
};

}  // namespace blem_sim
