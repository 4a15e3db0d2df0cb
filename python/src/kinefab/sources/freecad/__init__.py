"""FreeCAD's own documents, read without FreeCAD.

archive       the zip and its limits
document      the objects of Document.xml and their properties
links         documents beside the first one, and what a link shows
frames        what a link scales, and how it stands
occurrences   the tree of what stands where, links followed
parts         occurrences as the scene's nodes
shapes        their B-reps as meshes, through OpenCASCADE where it is installed
looks         colours of GuiDocument.xml, materials
references    what a joint's reference points at
joints        the Assembly workbench's joints
"""
