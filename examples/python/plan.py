"""An errand planned at its first step: the language model says how objects are used in turn, and the plan is kept to its end.

    lgabench run errands --preset smoke --methods human,examples/python/plan.py:Plan
"""
import numpy

from lgabench_method import select_meaning, wanted


class Plan:
    version = "0.1"
    summary = "a plan made at the first step of an errand"

    def select(self, command, space, services):
        return select_meaning(command, space, services.lm)

    def learn(self, demonstrations, services):
        labels = [step.label for one in demonstrations for step in one.steps if len(step.label)]  # "done" has no numbers
        return Planner(numpy.median(labels, 0), services.layout["action"])


class Planner:
    """Moves as demonstrations do, but takes hold of what the plan names."""

    def __init__(self, usual, actions):
        self.usual, self.numbers, self.takes_at = usual, actions["numbers"], actions["places"][0]
        self.reset()

    def reset(self):
        self.plan = None

    def act(self, observation, instruction):
        if self.plan is None:
            self.plan = self.planned(observation, instruction.selection.meaning)
        return self.plan.pop(0) if self.plan else []

    def planned(self, observation, meaning):
        table = [one for one in observation.instances if one.pixels and one.object_type != "pallet"]
        brought, plan = [], []
        while True:
            names = wanted(meaning, [(one.object_type, one.texture) for one in table], brought)
            if not names:
                return plan
            thing = next(one for one in table if (one.object_type, one.texture) == names[0])
            table.remove(thing)
            brought.append(names[0])
            plan.append(self.take(observation.ids == thing.id))
            if not meaning.turns:  # one object
                return plan

    def take(self, mask):
        """At the pixel of the mask that is nearest to its middle."""
        pixels = numpy.argwhere(mask)
        pixel = pixels[((pixels - pixels.mean(0)) ** 2).sum(1).argmin()]
        action = self.usual.copy()
        for axis, at in enumerate(self.takes_at):
            low, high = self.numbers[at]["low"], self.numbers[at]["high"]
            action[at] = low + (pixel[axis] + .5) / mask.shape[axis] * (high - low)
        return action
