"""Reads a DXF file with ezdxf and says what is in it, a line each:

    read_dxf.py FILE

    version R12
    units 4
    block NAME LAYER KIND CLOSED x y x y …      entities of blocks
    model - LAYER KIND CLOSED x y x y …         entities of the drawing itself
    text BLOCK LAYER TEXT                       in UTF-8, \\U+XXXX decoded
    errors N                                    what the auditor found

A file that ezdxf cannot read ends it with exit code 1.
"""

import sys

import ezdxf


def points_of(entity):
    kind = entity.dxftype()
    if kind == "LINE":
        return [entity.dxf.start, entity.dxf.end]
    if kind == "POLYLINE":
        return list(entity.points())
    if kind == "POINT":
        return [entity.dxf.location]
    if kind in ("INSERT", "TEXT"):
        return [entity.dxf.insert]
    raise ValueError(f"unexpected {kind}")


def describe(where, name, entity):
    if entity.dxftype() == "TEXT":
        print("text", name, entity.dxf.layer, ezdxf.decode_dxf_unicode(entity.dxf.text))
        return
    closed = int(entity.dxftype() == "POLYLINE" and entity.is_closed)
    numbers = " ".join(f"{x:.9f}" for p in points_of(entity) for x in (p[0], p[1]))
    target = entity.dxf.name if entity.dxftype() == "INSERT" else name
    print(where, target, entity.dxf.layer, entity.dxftype(), closed, numbers)


def main():
    sys.stdout.reconfigure(encoding="utf-8", errors="replace")
    drawing = ezdxf.readfile(sys.argv[1])
    print("version", drawing.acad_release)
    print("units", drawing.header.get("$INSUNITS", 0))
    for block in drawing.blocks:
        if block.name.startswith("*") or block.name.startswith("$"):
            continue
        for entity in block:
            describe("block", block.name, entity)
    for entity in drawing.modelspace():
        describe("model", "-", entity)
    print("errors", len(drawing.audit().errors))


main()
