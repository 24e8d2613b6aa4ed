"""The blade in its row: end walls, tip gap, and the periodic flow domain of one blade.

cylinder          points about the machine's axis
walls, read_walls hub and shroud as curves, and from files
trim              the blade between its walls
channel           the meridional plane, inlet to outlet
periodic          the mean camber, half a pitch from which the periodic faces stand
volume            of the fluid, by quadrature
frame, blade_faces, end_wall, region, steps, vertices
                  patches as triangles that share their vertices
orient, measure, assemble
                  patches wound alike, put together, measured
domain, row       the passage of one blade, and the whole row
"""
