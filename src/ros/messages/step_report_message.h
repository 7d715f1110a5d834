// The message StepReport and the struct StepReport of the sim room share a name and, as catkin generates it, a namespace. In C++ the
// message is called StepReportMessage; on the wire it keeps its name.
#pragma once

#define StepReport StepReportMessage
#include <blem_sim/StepReport.h>
#undef StepReport
