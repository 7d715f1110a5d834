"""What a robot's two feet carry while it shifts its weight: read from its ankle sensors, and reckoned from the motion of its masses."""
import kinematics

LINES = {"left": "tab:blue", "right": "tab:orange"}


def pose_in(row, body):
    """Pose of a free body in a row of states."""
    quaternion = [float(row["%s_q%s" % (body, k)]) for k in "xyzw"]
    return kinematics.from_quaternion(*quaternion), tuple(float(row["%s_%s" % (body, k)]) for k in "xyz")


def at(pose, point):
    """A point of a body, in the world."""
    return kinematics.added(pose[1], kinematics.turned(pose[0], point))


def second_difference(before, here, after, dt):
    return tuple((a - 2 * b + c) / dt ** 2 for a, b, c in zip(before, here, after))


def shares(points, centre):
    """By which shares two points carry a weight above the line between them."""
    (one, a), (other, b) = points.items()
    line, away = [kinematics.added(point, b, -1)[:2] for point in (a, centre)]
    share = (line[0] * away[0] + line[1] * away[1]) / (line[0] ** 2 + line[1] ** 2)
    return {one: share, other: 1 - share}


class FootForces:
    """Rows of states at every step of dt [s] -> vertical forces [N] by foot, measured and in theory.

    feet: foot -> (ankle sensor, foot link). A foot's measured force is what the ground must exert on the foot for its sensor to read what
    it reads: m_f (g + a_f) less the ankle's force. In theory the feet carry m g, divided by where the centre of mass stands along a line:
    `static` between the soles' middles (`soles`, points in the foot links), `balanced` between the centres of pressure that the ankles'
    torques tell. Their sum is m (g + a), a being the centre of mass's own acceleration.
    """

    def __init__(self, tree, robot, feet, soles, gravity, dt):
        self.tree, self.robot, self.feet, self.soles, self.gravity, self.dt = tree, robot, feet, soles, gravity, dt
        self.times, self.sum_theory = [], []
        self.measured, self.static, self.balanced = [{foot: [] for foot in feet} for _ in range(3)]

    def wanted(self, column):
        """Is this column of the states needed?"""
        if column.startswith(self.robot + "::"):
            name = column[len(self.robot) + 2:]
            return name.endswith("_joint") or name.startswith(self.tree.root + "_")
        return any(column.startswith(sensor + ".") for sensor, _ in self.feet.values())

    def read(self, rows):
        instants = []
        for row in rows:
            instants = instants[-2:] + [self._instant(row)]
            if len(instants) == 3:
                self.times.append(float(row["time"]))
                self._read_step(*instants)

    def _instant(self, row):
        """Row, link poses, centre of mass, centres of mass of the feet."""
        positions = {j.name: float(row["%s::%s" % (self.robot, j.name)]) for j in self.tree.joints if j.type != "fixed"}
        poses = self.tree.link_poses(positions, pose_in(row, "%s::%s" % (self.robot, self.tree.root)))
        centres = {foot: at(poses[link], self.tree.masses[link][1]) for foot, (_, link) in self.feet.items()}
        return row, poses, self.tree.centre_of_mass(poses), centres

    def _read_step(self, before, start, end):
        """The forces of the step from start to end: they made the difference of its velocity and the last step's."""
        weight, pressed = self.tree.total_mass() * self.gravity, {}
        a = second_difference(before[2], start[2], end[2], self.dt)
        self.sum_theory.append(weight + self.tree.total_mass() * a[2])
        for foot, (sensor, link) in self.feet.items():
            a_foot = second_difference(before[3][foot], start[3][foot], end[3][foot], self.dt)
            force, pressed[foot] = self._ground(end, foot, sensor, link, a_foot)
            self.measured[foot].append(force)
        soles = {foot: at(start[1][link], self.soles[foot]) for foot, (_, link) in self.feet.items()}
        for points, forces in ((soles, self.static), (pressed, self.balanced)):
            for foot, share in shares(points, start[2]).items():
                forces[foot].append(share * weight)

    def _ground(self, instant, foot, sensor, link, acceleration):
        """Vertical force of the ground on a foot and where it acts; the middle of the sole under a foot that carries less than 1 N."""
        row, poses, _, centres = instant
        ankle, lift = poses[link][1], self.tree.masses[link][0]
        force, torque = [kinematics.turned(poses[link][0], [float(row["%s.%s_%s" % (sensor, kind, k)]) for k in "xyz"])
                         for kind in ("force", "torque")]
        inertial = tuple(lift * x for x in kinematics.added(acceleration, (0, 0, self.gravity)))
        ground = kinematics.added(inertial, force, -1)
        moment = kinematics.added(kinematics.cross(kinematics.added(centres[foot], ankle, -1), inertial), torque, -1)
        sole = at(poses[link], self.soles[foot])
        if ground[2] < 1:
            return ground[2], sole
        below = sole[2] - ankle[2]
        away = ((below * ground[0] - moment[1]) / ground[2], (below * ground[1] + moment[0]) / ground[2], below)
        return ground[2], kinematics.added(ankle, away)

    def sums(self):
        return [sum(forces) for forces in zip(*self.measured.values())]

    def steps_between(self, start, end):
        return [k for k, time in enumerate(self.times) if start <= time <= end]

    def plot(self, path):
        import matplotlib
        matplotlib.use("Agg")
        from matplotlib import pyplot
        figure, (forces, off) = pyplot.subplots(2, 1, sharex=True, figsize=(9, 7), gridspec_kw={"height_ratios": [3, 1]})
        for foot in self.feet:
            forces.plot(self.times, self.measured[foot], color=LINES[foot], label="%s foot, by its ankle sensor" % foot)
            forces.plot(self.times, self.balanced[foot], "--", color="black", linewidth=0.8, label="quasi-static, centres of pressure")
            forces.plot(self.times, self.static[foot], ":", color=LINES[foot], label="%s foot, quasi-static, soles' middles" % foot)
        forces.plot(self.times, self.sums(), color="black", label="sum")
        forces.set_ylabel("vertical force [N]")
        forces.set_ylim(-50, 1.6 * self.tree.total_mass() * self.gravity)
        lines = {line.get_label(): line for line in forces.get_lines()}
        forces.legend(lines.values(), lines.keys(), loc="upper right", fontsize="small")
        off.plot(self.times, [a - b for a, b in zip(self.sums(), self.sum_theory)], color="black")
        off.set_ylabel("sum - m (g + a) [N]")
        off.set_ylim(-0.5, 0.5)
        off.set_xlabel("time [s]")
        figure.tight_layout()
        figure.savefig(str(path), dpi=100)
