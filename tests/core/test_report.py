import json
import math

import hybrid_quad
from hybrid_quad.core import report


def test_failures_keep_code_and_elements():
    options = hybrid_quad.RemeshOptions(seed=3)
    error = hybrid_quad.InputError("non_orientable", "one side only", "face", [1, 2])
    made = report.failed("input_error", error, options, "1.2.3")
    assert made["status"] == "input_error"
    assert (made["code"], made["elements"], made["message"]) == ("non_orientable", [1, 2], "one side only")
    assert made["options"]["seed"] == made["seed"] == 3
    assert json.loads(report.as_text(made)) == made


def test_numbers_that_json_lacks_become_null():
    assert json.loads(report.as_text({"a": [math.nan, 1.5, math.inf]})) == {"a": [None, 1.5, None]}
