import math

import numpy as np
import pytest

from hybrid_quad import RemeshOptions
from hybrid_quad.core import native


@pytest.mark.parametrize(
    "wrong",
    [
        {"quads": 0},
        {"quads": 2.5},
        {"quads": True},
        {"quads": 10**7},
        {"edge_length": 0.0},
        {"edge_length": math.inf},
        {"edge_length": math.nan},
        {"sharp_angle": -1.0},
        {"sharp_angle": 181.0},
        {"sharp_angle": math.nan},
        {"field_smoothness": -0.1},
        {"adaptivity": 1.1},
        {"adaptivity": math.nan},
        {"chord_error": 0.0},
        {"chord_error": math.inf},
        {"chord_error": 0.1, "adaptivity": 0.5},
        {"narrow_quads": 0},
        {"narrow_quads": 3},
        {"narrow_quads": 1.5},
        {"anisotropy": 0.5},
        {"anisotropy": math.inf},
        {"size_fidelity": 2.0},
        {"fit_limit_surface": 1},
        {"symmetry": "xx"},
        {"symmetry": "w"},
        {"symmetry": "autox"},
        {"symmetry_center": "middle"},
        {"symmetry_center": (0.0, math.nan, 0.0)},
        {"symmetry_center": (0.0, 1.0)},
        {"symmetry_center": 0.0},
        {"solver": "guess"},
        {"seed": -1},
        {"seed": 2**64},
        {"threads": -1},
        {"threads": 2**16},
        {"time_limit": 0.0},
        {"time_limit": math.nan},
        {"quads": np.array([40])},
        {"seed": np.array([1, 2])},
    ],
    ids=str,
)
def test_options_that_make_no_sense_are_refused_by_name(wrong):
    with pytest.raises(ValueError, match=next(iter(wrong))):
        RemeshOptions(**wrong)


@pytest.mark.parametrize(
    "name", ["edge_length", "sharp_angle", "field_smoothness", "anisotropy", "chord_error", "time_limit"]
)
def test_what_is_no_number_is_refused_by_name(name):
    for wrong in (
        "1",
        [1.0],
        *([] if RemeshOptions.__dataclass_fields__[name].default is None or name == "sharp_angle" else [None]),
    ):
        with pytest.raises(TypeError, match=name):
            RemeshOptions(**{name: wrong})


def test_defaults_are_those_of_the_core():
    ours, cores = RemeshOptions().for_native(), native.load().default_options()
    assert cores == {name: ours[name] for name in cores}


def test_native_arguments_carry_every_option():
    native = RemeshOptions(quads=7, sharp_angle=None, threads=0).for_native()
    assert native["quads"] == 7
    assert native["edge_length"] == 0.0
    assert native["sharp_angle"] is None
    assert native["threads"] >= 1
    # The centre is no argument: the points are moved there.
    assert set(native) == set(RemeshOptions.__dataclass_fields__) - {"symmetry_center"}
