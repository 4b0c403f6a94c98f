import pickle

import hybrid_quad


def test_input_error_is_a_value_error_that_names_elements():
    error = hybrid_quad.InputError("non_orientable", "the surface has one side", "face", [3, 4])
    assert isinstance(error, ValueError)
    assert str(error) == "the surface has one side"
    assert (error.code, error.element_kind, error.elements) == ("non_orientable", "face", (3, 4))


def test_errors_survive_the_way_between_processes():
    for error in (
        hybrid_quad.InputError("empty_mesh", "no faces"),
        hybrid_quad.Cancelled("stopped", "time_limit"),
        hybrid_quad.InternalError("broken", "assemble"),
    ):
        copy = pickle.loads(pickle.dumps(error))
        assert type(copy) is type(error)
        assert str(copy) == str(error)
        assert vars(copy) == vars(error)
