"""Makes the workbooks beside it: python3 make.py (needs openpyxl, xlwt, odfpy).

Each holds a sheet without numbers and a sheet `data`: a preamble, a header, units, and eight rows of DoLP in percent, one not measured.
`far.xlsx` has a lone word in the last cell that a sheet has; `backwards.xlsx` has its rows in reverse order in the file.
"""
import zipfile, re, io
import openpyxl, xlwt
from odf.opendocument import OpenDocumentSpreadsheet
from odf.table import Table, TableCell, TableRow
from odf.text import P

ROWS = [["sample", "steel"], [], ["theta_i", "theta_r", "DoLP"], ["deg", "deg", "%"]]
ROWS += [[30, 10 * i, "n/a" if i == 5 else 10 + i / 4] for i in range(8)]

book = openpyxl.Workbook()
book.active.title = "notes"
book.active["A1"] = "nothing here"
sheet = book.create_sheet("data")
for row in ROWS:
    sheet.append(row)
book.save("steel.xlsx")

sheet["XFD1048576"] = "x"
book.save("far.xlsx")

source = zipfile.ZipFile("steel.xlsx")
with zipfile.ZipFile("backwards.xlsx", "w", zipfile.ZIP_DEFLATED) as target:
    for name in source.namelist():
        data = source.read(name).decode()
        if name.endswith("sheet2.xml"):
            rows = re.findall(r"<row .*?</row>", data, re.S)
            head, tail = data.split(rows[0])[0], data.split(rows[-1])[1]
            data = head + "".join(reversed(rows)) + tail
        target.writestr(name, data)

book = xlwt.Workbook()
book.add_sheet("notes").write(0, 0, "nothing here")
sheet = book.add_sheet("data")
for i, row in enumerate(ROWS):
    for j, cell in enumerate(row):
        sheet.write(i, j, cell)
book.save("steel.xls")

document = OpenDocumentSpreadsheet()
for name, rows in [("notes", [["nothing here"]]), ("data", ROWS)]:
    table = Table(name=name)
    for row in rows:
        line = TableRow()
        for cell in row:
            kind = {"valuetype": "string"} if isinstance(cell, str) else {"valuetype": "float", "value": cell}
            holder = TableCell(**kind)
            holder.addElement(P(text=str(cell)))
            line.addElement(holder)
        table.addElement(line)
    document.spreadsheet.addElement(table)
document.save("steel.ods")
