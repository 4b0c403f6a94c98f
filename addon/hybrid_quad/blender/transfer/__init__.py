"""What a result takes along from its source: a file for each kind.

`layers.read` copies what a source carries, before the run. What the result gets of it is computed from arrays alone
(`layers.request_of`, core/transfer), by a worker process where there is one; `layers.write` puts it on the result. `object_data`
does what belongs to the object.
"""
