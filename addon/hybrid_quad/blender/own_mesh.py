"""A mesh of our own that can be read or made piece by piece, whatever the user does meanwhile."""

from __future__ import annotations

import contextlib
import uuid
import weakref
from collections.abc import Iterator
from typing import Any

import bpy
from bpy.app.handlers import persistent

from ..core.errors import InputError

_TOKEN = "hybrid_quad_own"
_NAME = ".hybrid_quad"  # names with a point in front are not offered in menus


class OwnMesh:
    """A mesh that no object of the user's has.

    It belongs to the file, as nothing else lives on while the scene is evaluated anew. Undo and loading a file take it away, so it
    is never kept but looked for.

    Parameters
    ----------
    mesh : Mesh
        Belongs to this from now on.
    of : str
        Name of the object that it is made for.
    """

    def __init__(self, mesh: bpy.types.Mesh, of: str) -> None:
        self._of, self._name, self._token = of, mesh.name, uuid.uuid4().hex
        mesh[_TOKEN] = self._token
        mesh.name = _NAME
        _living.add(self)

    def mesh(self) -> bpy.types.Mesh:
        """The mesh.

        Raises
        ------
        InputError
            ``mesh_gone``, after an undo.
        """
        found = self._find()
        if found is None:
            raise InputError(
                "mesh_gone", f'While "{self._of}" was being read, a step was undone or redone: start again'
            )
        return found

    @contextlib.contextmanager
    def held(self) -> Iterator[bpy.types.Object]:
        """For a while an object that has the mesh: vertex groups are reached through one only."""
        holder = bpy.data.objects.new(_NAME, self.mesh())
        try:
            yield holder
        finally:
            bpy.data.objects.remove(holder)

    def release(self) -> bpy.types.Mesh:
        """The mesh, which belongs to the caller from now on; raises as :meth:`mesh`."""
        mesh = self.mesh()
        _living.discard(self)
        del mesh[_TOKEN]
        mesh.name = self._name
        return mesh

    def is_there(self) -> bool:
        """Whether no undo has taken the mesh away."""
        return self._find() is not None

    def remove(self) -> None:
        """Removes the mesh, if it is still there."""
        _living.discard(self)
        found = self._find()
        if found is not None:
            bpy.data.meshes.remove(found)

    def _find(self) -> bpy.types.Mesh | None:
        return next((mesh for token, mesh in _all() if token == self._token), None)

    def is_of(self, token: str) -> bool:
        """Whether a mesh with this token is this one's."""
        return token == self._token


_living: weakref.WeakSet[OwnMesh] = weakref.WeakSet()


def remove_strays() -> None:
    """Removes what nobody has any more.

    An undo step that was pushed while there was such a mesh has it, even without users, and brings it back; so may a file that was
    saved from such a step after a crash.
    """
    for mesh in [mesh for token, mesh in _all() if not any(own.is_of(token) for own in _living)]:
        bpy.data.meshes.remove(mesh)


def register() -> None:
    """Looks for strays wherever they may come from."""
    for handlers in _handlers():
        handlers.append(_on_change_of_file)


def unregister() -> None:
    """Looks no more; safe where it never did."""
    for handlers in _handlers():
        with contextlib.suppress(ValueError):
            handlers.remove(_on_change_of_file)


def _all() -> list[tuple[str, bpy.types.Mesh]]:
    return [(mesh[_TOKEN], mesh) for mesh in bpy.data.meshes if mesh.name.startswith(_NAME) and _TOKEN in mesh]


def _handlers() -> tuple[Any, ...]:
    return bpy.app.handlers.undo_post, bpy.app.handlers.redo_post, bpy.app.handlers.load_post


@persistent
def _on_change_of_file(*_arguments: Any) -> None:
    remove_strays()
