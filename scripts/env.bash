# source scripts/env.bash: roslaunch blem_sim ... and rosrun blem_sim ... work in this shell afterwards.
source "$(dirname "${BASH_SOURCE[0]}")/support/common.bash"
blem_sim_use_build "${BLEM_SIM_BUILD_DIR:-$BLEM_SIM_ROOT/build_release}"
