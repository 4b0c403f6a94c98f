import errno

import meshio
import numpy as np
import pytest

from hybrid_quad.core.snapshots import Snapshot, SnapshotFolder


def stage():
    return Snapshot(
        stage="frame field / 1",
        points=np.array([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0], [2, 0, 0], [3, 1, 0], [2, 2, 0]], float),
        face_sizes=np.array([3, 4, 3, 5], np.int32),
        face_vertices=np.array([0, 1, 2, 1, 4, 5, 2, 0, 2, 3, 2, 5, 6, 3, 0], np.int32),
        vertex_values={"height": np.arange(7.0)},
        face_values={"region": np.array([10.0, 11.0, 12.0, 13.0])},
        face_vectors={"u": np.arange(12.0).reshape(4, 3)},
        lines=np.array([[0, 1], [1, 2]], np.int32),
    )


def test_a_written_stage_can_be_read_with_its_arrays(tmp_path):
    snapshot = stage()
    folder = SnapshotFolder(tmp_path / "new" / "stages")
    first, second = folder.write(snapshot), folder.write(snapshot)
    assert [first.name, second.name] == ["00_frame_field_1.vtu", "01_frame_field_1.vtu"]
    mesh = meshio.read(first)
    assert np.array_equal(mesh.points, snapshot.points)
    assert np.array_equal(mesh.point_data["height"], np.arange(7.0))
    for block, region, u in zip(mesh.cells, mesh.cell_data["region"], mesh.cell_data["u"], strict=True):
        if block.type == "triangle":
            assert block.data.tolist() == [[0, 1, 2], [0, 2, 3]]
            assert region.tolist() == [10, 12]
            assert u.tolist() == [[0, 1, 2], [6, 7, 8]]
    assert {block.type: len(block.data) for block in mesh.cells} == {"triangle": 2, "quad": 1, "polygon": 1, "line": 2}


def test_a_full_disk_is_told_with_the_file(tmp_path, monkeypatch):
    def fail(*_, **__):
        raise OSError(errno.ENOSPC, "No space left on device")

    monkeypatch.setattr(meshio.Mesh, "write", fail)
    with pytest.raises(OSError, match="No space left") as caught:
        SnapshotFolder(tmp_path).write(stage())
    assert caught.value.filename == str(tmp_path / "00_frame_field_1.vtu")
