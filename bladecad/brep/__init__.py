"""The one room that knows cadquery and OCCT: faces, caps, the solid and its witnesses."""
