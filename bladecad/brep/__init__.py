"""The one room that knows cadquery and OCP: patches become a solid, files become solids again.

    names, limits   words and numbers, free of the kernel
    outline         do the two sides bound a blade at all?
    caps            the two ends: a plane where they are planar, else ruled
    faces           arrays become kernel faces
    sew             faces become one closed solid, names kept
    witnesses       why the solid is believed
    astray          how far its faces are from the sides they were made of
    seen, joints    how smoothly its faces meet
    solid           all of it in one verb, `build_solid`
    labels          names, colours and layers of faces
    reread, confirm a CAD file read back, and compared with its solid
    patches         the faces of any STEP file as arrays
    kernel, statics the door to the kernel, and its global settings

cadquery takes seconds to import, so this file imports nothing.
"""
