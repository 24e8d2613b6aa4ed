"""One replay of the default blade for all tests, with one more blade on the ladder."""

import pytest

from bladecad.replay.blades import default_blade, others
from bladecad.replay.results import found


@pytest.fixture(scope="session")
def results():
    cold = next(blade for blade in others() if blade.name == "Rotor 37, cold")
    return found(default_blade(), [cold])
