#pragma once

#include "hybrid_quad/assemble/assemble.h"
#include "hybrid_quad/base/snapshot.h"
#include "hybrid_quad/mesh/unit_frame.h"

namespace hybrid_quad {

/// The input as it was repaired, before anything is cut or moved. "opposite of side 0" to 2 at faces: 3 times the face across
/// plus its side there, -1 at the boundary (vertices alone do not say it where a cut has both ends in common with an edge).
Snapshot snapshot_of(const TriangleMesh& mesh);
Snapshot snapshot_of(const TriangleMesh& mesh, const FeatureGraph& features);
Snapshot snapshot_of(const WorkingSurface& surface);
/// "u direction", "v direction" as face vectors, "cone index" at vertices
Snapshot snapshot_of(const FrameField& field, const WorkingSurface& surface, const std::string& stage);
/// "morse" at vertices
Snapshot snapshot_of(const PeriodicField& psi, const WorkingSurface& surface);
/// "regular", "charge" at faces
Snapshot snapshot_of(const SpanningParameterization& param, const WorkingSurface& surface);
/// the overlay's pieces with "quad" (-1 = singular region) and "patch" at faces
Snapshot snapshot_of(const RegularQuads& regular, const SingularPatches& singular);
Snapshot snapshot_of(const QuadMesh& quads, const std::string& stage);

/// What a stage saw inside the frame, with points and lengths in the caller's units.
Snapshot in_scene(Snapshot snapshot, const UnitFrame& frame);

}  // namespace hybrid_quad
