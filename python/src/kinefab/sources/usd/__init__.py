"""USD stages with UsdPhysics: the only room that imports pxr.

The schemas are read prim by prim, not through ``LoadUsdPhysicsFromRange``: that parser is parallel and corrupts the heap
in usd-core before 26.5 where a body has many colliders, and it leaves mass, units and signs to its caller anyway.

Road: ``stage`` opens, ``walk`` finds what is a body, a collider, a joint, ``parts`` and ``physics`` turn them into nodes and
joints of the scene.  Matrices are column form here (a point is ``m[:3, :3] @ p + m[:3, 3]``), pxr's are row form.
"""
