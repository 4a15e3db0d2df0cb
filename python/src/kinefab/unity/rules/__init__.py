"""What must hold of a written scene: the rules of ``dotnet kinefab validate`` that are errors, with its codes and
places.

One file a noun; ``shape`` has those that the schema says.  Who breaks one is refused wherever Python reads scenes, so
that nothing is written on from a file that the C# library, and with it Unity, would not take.
"""
