"""Many assets: what to run, one asset's run, and engines that share the runs out.

Data flows from inputs (`job_list`) to assets (`asset`), through `run_asset`, which every engine calls and which leaves a
result and a status file, to the summary of all status files (`summary`). Nothing here knows Blender; a `.blend` file's
objects are remeshed by a Blender that is started as any other worker process is.
"""
