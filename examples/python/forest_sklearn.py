"""A random forest of scikit-learn on the moments of the goal mask: its area, centre and covariances.

    lgabench run q1 --methods lga,examples/python/forest_sklearn.py:Forest
"""
import numpy
from sklearn.ensemble import RandomForestRegressor

from lgabench_method import FeatureSet, Selection, goal_mask, select_features


class Forest:
    version = "0.1"
    questionnaire = True
    summary = "a random forest on the moments of the goal mask"
    options = {
        "trees": {"default": 100, "min": 1, "help": "trees of the forest", "source": "scikit-learn"},
    }

    def select(self, command, space, services):
        return select_features(command, space, services.lm)

    def learn(self, demonstrations, services):
        pairs = [(moments(step.observation, demonstration.instruction), step.label)
                 for demonstration in demonstrations for step in demonstration.steps]
        inputs, labels = map(numpy.stack, zip(*pairs))
        forest = RandomForestRegressor(services.options["trees"], random_state=services.seed % 2**32, n_jobs=1)
        return Policy(forest.fit(inputs, labels))


def moments(observation, instruction):
    """Area, centre and (co)variances, in pixels, of the target's mask and of the second set's: 12 numbers."""
    numbers = []
    for features in (instruction.selection.target, instruction.selection.second or FeatureSet()):
        rows, columns = numpy.nonzero(goal_mask(observation, Selection(target=features)))
        if len(rows) == 0:
            numbers += [0.0] * 6
            continue
        spread = numpy.cov(rows, columns, bias=True)
        numbers += [len(rows), rows.mean(), columns.mean(), spread[0, 0], spread[1, 1], spread[0, 1]]
    return numpy.array(numbers)


class Policy:
    def __init__(self, forest):
        self.forest = forest

    def act(self, observation, instruction):
        return self.forest.predict([moments(observation, instruction)])[0]
