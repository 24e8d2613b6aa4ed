"""The one room that knows cadquery and OCP: patches become a solid, files become solids again.

    names, limits   words and numbers, free of the kernel
    outline         do the two sides bound a blade at all?
    caps            the two ends: a plane where they are planar, else ruled
    faces           arrays become kernel faces
    sew             faces become one closed solid, names kept
    witnesses       why the solid is believed
    solid           all of it in one verb, `build_solid`
    reread, confirm a STEP file read back, and compared with its solid
    kernel, statics the door to the kernel, and its global settings

cadquery takes seconds to import, so this file imports nothing.
"""
