"""A bad mesh as one file, for a report: what a run reads, what came of it, and how to do it again.

Data flows from files and settings to a folder with all that the run reads under plain names (`case_inputs`), through the run
(`case_run`), to a zip file (`case_file`) and back. Nothing in such a file is ever run: it has settings, not commands.
"""
