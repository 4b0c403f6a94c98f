"""What is drawn over objects in the 3D view: the field before a run, the limit surface after it."""
