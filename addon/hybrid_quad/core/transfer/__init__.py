"""What a result takes along from its source, as far as it is arrays: computed in any process, without Blender."""
