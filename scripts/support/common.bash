# Sourced by the other scripts: where things are, and a ROS environment on Debian (/usr) and on Noetic (/opt/ros).
BLEM_SIM_ROOT="$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)"

blem_sim_ros_environment() {
  local setup
  for setup in /opt/ros/*/setup.bash; do
    if [ -z "${ROS_DISTRO:-}" ] && [ -f "$setup" ]; then
      # shellcheck disable=SC1090
      source "$setup"
    fi
  done
  # ROS on Debian lives in /usr, and its Python modules with Debian's own interpreter: a python3 from elsewhere would not find them.
  if [ ! -d /opt/ros ]; then
    case ":$PATH:" in
      /usr/bin:*|:/usr/bin:*) ;;
      *) export PATH="/usr/bin:$PATH" ;;
    esac
    export ROS_DISTRO="${ROS_DISTRO:-Debian}"
    export ROS_PACKAGE_PATH="${ROS_PACKAGE_PATH:-/usr/share}"
    export ROS_ROOT="${ROS_ROOT:-/usr/share/ros}"
    export ROS_MASTER_URI="${ROS_MASTER_URI:-http://localhost:11311}"
  fi
  # A machine whose own name does not resolve cannot talk to its own nodes.
  if [ -z "${ROS_HOSTNAME:-}${ROS_IP:-}" ] && ! getent hosts "$(uname -n)" >/dev/null; then
    export ROS_HOSTNAME=localhost
  fi
}

# Writes a JUnit file that says that a program ended before it wrote its own, so that this counts as a failure. Arguments: program, file.
blem_sim_report_crash() {
  printf '<testsuite name="%s"><testcase name="ran to its end"><failure/></testcase></testsuite>\n' "$1" >"$2"
}
export -f blem_sim_report_crash

# Puts a built tree on this shell. Argument: its build folder.
blem_sim_use_build() {
  blem_sim_ros_environment
  local setup="$1/devel/setup.bash"
  if [ ! -f "$setup" ]; then
    echo "blem_sim: nothing is built in $1; run scripts/build first" >&2
    return 1
  fi
  # shellcheck disable=SC1090
  source "$setup"
}
