"""Random surfaces with random wishes for the whole pipeline: see ``fuzz_pipeline.py``."""
