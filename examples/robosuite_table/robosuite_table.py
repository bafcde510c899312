"""Groceries and nuts on robosuite's table, picked by its Panda: an environment for lgabench (docs/simulators.md).

    python3 -m venv robosuite_venv && robosuite_venv/bin/pip install robosuite==1.5.2 mujoco==3.3.2
    sudo apt-get install libosmesa6
    export MUJOCO_GL=osmesa LGABENCH_PYTHON=robosuite_venv/bin/python

Robot, table, meshes and controller are the package's. An action is a place in the picture of a camera above. The arm picks
the thing whose middle, or handle, is nearest: it goes to where that thing is held, turned to it, closes, lifts, and tries once
more if it has lifted nothing. So an action says which thing; whether the hand gets it is physics.
"""
import numpy
from lgabench_environment import Environment, Observation, Result

INSTALL = ("pip install robosuite==1.5.2 mujoco==3.3.2, for the interpreter of LGABENCH_PYTHON or --python; "
           "apt-get install libosmesa6; export MUJOCO_GL=osmesa")
TABLE = .8                        # how high it is
DOWN, ACROSS = (-.285, .165), (-.45, .45)  # what the camera sees of the table, in metres: x of the world, and y
CAMERA, FOVY = 1.2, 2 * numpy.degrees(numpy.arctan(.225 / 1.2))  # above the table; so it sees .45 m of it
CELLS = [(x, y) for x in (-.19, -.045, .1) for y in (-.34, -.17, 0., .17, .34)]
JITTER, TURN = .015, numpy.pi / 6  # of a thing in its cell
PARKED = [0., -1.2, 0., -2.85, 0., 1.65, numpy.pi / 4]  # joints of the arm, out of the picture
REACH = .06                       # where no thing lies so near to an action's place, the arm stays
ABOVE, LIFTED = .28, .06          # heights over the table: where the hand moves; so far up, a thing is lifted
CLASSES = {"milk": "Milk", "cereal": "Cereal", "can": "Can", "square nut": "SquareNut", "round nut": "RoundNut",
           "bottle": "Bottle", "lemon": "Lemon", "bread": "Bread"}
HANDLE = {"square nut": (.054, 0.), "round nut": (.06, 0.)}  # where a thing is held, from its middle

def make_table(**options):
    """robosuite's own environment: a Panda, the table, all things, one camera."""
    try:
        import robosuite.models.objects as objects
        from robosuite.environments.manipulation.manipulation_env import ManipulationEnv
        from robosuite.models.arenas import TableArena
        from robosuite.models.tasks import ManipulationTask
    except ImportError as error:
        raise ImportError(f"{error}: {INSTALL}") from error

    class Table(ManipulationEnv):
        def _load_model(self):
            super()._load_model()
            self.robots[0].init_qpos = numpy.array(PARKED)
            self.robots[0].robot_model.set_base_xpos(self.robots[0].robot_model.base_xpos_offset["table"](.8))
            arena = TableArena(table_full_size=(.8, 1., .05), table_offset=(0, 0, TABLE))
            arena.set_origin([0, 0, 0])
            middle = (sum(DOWN) / 2, sum(ACROSS) / 2, TABLE + CAMERA)
            arena.set_camera("above", middle, (numpy.sqrt(.5), 0, 0, numpy.sqrt(.5)), {"fovy": str(FOVY)})
            self.things = {name: getattr(objects, f"{kind}Object")(kind) for name, kind in CLASSES.items()}
            self.model = ManipulationTask(arena, [robot.robot_model for robot in self.robots], list(self.things.values()))

        def reward(self, action=None):
            return 0.

    return Table(robots="Panda", initialization_noise=None, use_camera_obs=False, has_offscreen_renderer=True,
                 has_renderer=False, ignore_done=True, hard_reset=False, seed=0, **options)


class RobosuiteTable(Environment):
    """A Panda picks the thing that the command means from robosuite's table"""
    id = "robosuite_table"
    version = "0.1"
    tasks = [{"id": "pick", "layouts": ["table"], "example": "robosuite_drink"}]
    failures = ["missed", "not_lifted", "wrong_thing"]
    space = "robosuite_table"
    things = [("milk", "carton"), ("cereal", "carton"), ("can", "metal"), ("square nut", "metal"), ("round nut", "metal"),
              ("bottle", "glass"), ("lemon", "food"), ("bread", "food")]
    actions = [("down", "m", -.285, .165), ("across", "m", -.45, .45)]
    places = [[0, 1]]
    picture = (128, 256)
    most_instances = 7
    packages = ["robosuite", "mujoco"]
    scene_members = ["distractors", "near_miss"]  # sample() is the base class's, which reads them

    def place(self, things, random):
        """Each thing in a cell of its own."""
        for thing, cell in zip(things, random.permutation(len(CELLS))):
            down, across = random.uniform(-JITTER, JITTER, size=2)
            thing.place = (CELLS[cell][0] + float(down), CELLS[cell][1] + float(across))
            thing.yaw = float(random.uniform(-TURN, TURN))

    def reset(self, scene):
        if not hasattr(self, "table"):
            self.table = make_table()
            self.measure()
        self.scene = scene
        self.table.reset()
        there = {thing.object_type: thing for thing in scene.things}
        for number, name in enumerate(CLASSES):  # what is not there lies on the floor, behind the robot
            thing = there.get(name)
            at = (*thing.place, TABLE) if thing else (-3 - .5 * number, 0, 0)
            yaw = thing.yaw / 2 if thing else 0
            height = at[2] - self.bottom[name] + .001
            self.joint(name)[:] = (at[0], at[1], height, numpy.cos(yaw), 0, 0, numpy.sin(yaw))
        self.table.sim.forward()
        return self.observe()

    def step(self, action):
        place = numpy.array(action)
        away = {thing.object_type: min(numpy.linalg.norm(at - place) for at in self.places_of(thing.object_type))
                for thing in self.scene.things}
        name = min(away, key=away.get)
        if away[name] > REACH:
            return Result(self.observe(), failure="missed")
        before = {one: self.joint(one)[2] for one in away}
        for deeper in (0, .015):  # the second try finds the thing where the first one left it
            self.pick(name, deeper)
            up = {one: self.joint(one)[2] - before[one] for one in before}
            lifted = [thing for thing in self.scene.things if up[thing.object_type] > LIFTED]
            if lifted:
                break
        if not lifted:
            return Result(self.observe(), failure="not_lifted")
        success = [thing.role for thing in lifted] == ["target"]
        return Result(self.observe(), success, "" if success else "wrong_thing", taken=lifted[0].instance_id)

    def expert_action(self, instance=None):
        thing = self.scene.target if instance is None else self.scene.find(instance)
        return self.held_at(thing.object_type)  # a nut's middle is a hole: no pixel of it

    def measure(self):
        """Heights from the geoms: the package's bottom_offset lies centimetres below them. What each geom belongs to."""
        model, data = self.table.sim.model._model, self.table.sim.data._data
        self.bottom, self.top, self.owner = {}, {}, numpy.full(model.ngeom + 1, "", object)  # the last: no geom
        for name, thing in self.table.things.items():
            body = model.body(thing.root_body).id
            self.joint(name)[:] = (0, 0, 0, 1, 0, 0, 0)
            self.table.sim.forward()
            heights = []
            for geom in numpy.flatnonzero(model.body_rootid[model.geom_bodyid] == body):
                self.owner[geom] = name
                mesh = model.geom_dataid[geom]
                corners = numpy.array([(a, b, c) for a in (-1, 1) for b in (-1, 1) for c in (-1, 1)]) * model.geom_size[geom]
                if mesh >= 0:
                    first = model.mesh_vertadr[mesh]
                    corners = model.mesh_vert[first:first + model.mesh_vertnum[mesh]]
                heights += list((corners @ data.geom_xmat[geom].reshape(3, 3).T + data.geom_xpos[geom])[:, 2])
            self.bottom[name], self.top[name] = min(heights), max(heights)

    def joint(self, name):
        """A thing's position and quaternion in the simulation, to read and to write."""
        model, data = self.table.sim.model._model, self.table.sim.data._data
        first = model.joint(self.table.things[name].joints[0]).qposadr[0]
        return data.qpos[first:first + 7]

    def yaw(self, name):
        w, x, y, z = self.joint(name)[3:]
        return numpy.arctan2(2 * (w * z + x * y), 1 - 2 * (y * y + z * z))

    def places_of(self, name):
        return self.joint(name)[:2], self.held_at(name)

    def held_at(self, name):
        yaw, (x, y) = self.yaw(name), HANDLE.get(name, (0., 0.))
        return self.joint(name)[:2] + (x * numpy.cos(yaw) - y * numpy.sin(yaw), x * numpy.sin(yaw) + y * numpy.cos(yaw))

    def pick(self, name, deeper):
        """Over the place, down, close, up. Fingers close across the thing, by less than a quarter turn."""
        place = self.held_at(name)
        turn = (self.yaw(name) + numpy.pi / 2) % numpy.pi - numpy.pi / 2
        top = self.joint(name)[2] + self.top[name]
        low = max(top - .045 - deeper, TABLE + (.008 if deeper else .012))
        self.move((*place, TABLE + ABOVE), turn, -1, .015, 70)
        self.move((*place, low), turn, -1, .004, 45)
        self.move((*place, low), turn, 1, 0, 10)
        self.move((*place, TABLE + ABOVE), turn, 1, .03, 35)

    def move(self, goal, turn, fingers, close_enough, most):
        """Control steps of the package's controller, towards a place and a turn of the hand about the vertical."""
        robot, data = self.table.robots[0], self.table.sim.data._data
        site = robot.eef_site_id["right"]
        across = numpy.array((-numpy.sin(turn), numpy.cos(turn), 0))
        wanted = numpy.stack([across, numpy.cross((0, 0, -1), across), (0, 0, -1)], axis=1)
        for _ in range(most):
            left = numpy.array(goal) - data.site_xpos[site]
            error = wanted @ data.site_xmat[site].reshape(3, 3).T
            axis = numpy.array((error[2, 1] - error[1, 2], error[0, 2] - error[2, 0], error[1, 0] - error[0, 1])) / 2
            sine = numpy.linalg.norm(axis)
            angle = numpy.arctan2(sine, (numpy.trace(error) - 1) / 2)
            if numpy.linalg.norm(left) < close_enough and angle < .05:
                break
            turned = axis * (angle / sine if sine > 1e-9 else 1)
            self.table.step(numpy.clip(numpy.concatenate([left / .05, turned / .5, [fingers]]), -1, 1))

    def observe(self):
        picture = {"camera_name": "above", "width": self.picture[1], "height": self.picture[0]}
        rgb = self.table.sim.render(**picture)[::-1]
        geoms = self.table.sim.render(segmentation=True, **picture)[::-1, :, 1]
        ids = numpy.zeros(self.picture, numpy.uint8)
        owners = self.owner[geoms]
        for thing in self.scene.things:
            ids[owners == thing.object_type] = thing.instance_id
        return Observation(numpy.ascontiguousarray(rgb), ids)
