"""A table that is as high as its rows, including the borders that a theme adds."""

from PySide import QtCore, QtGui

SPARE = 2  # pixels for the line below the rows


class WholeTable(QtGui.QTreeWidget):
    """Rows without a hierarchy. The first column takes the remaining width. Scrolls if there are more than
    `most` rows."""

    def __init__(self, headings, most=100):
        super().__init__()
        self._most = most
        self.setRootIsDecorated(False)
        self.setUniformRowHeights(True)
        self.setHeaderLabels(headings)
        self.setHorizontalScrollBarPolicy(QtCore.Qt.ScrollBarAlwaysOff)
        header = self.header()
        header.setStretchLastSection(False)
        header.setMinimumSectionSize(10)
        for column in range(len(headings)):
            header.setSectionResizeMode(column, QtGui.QHeaderView.ResizeToContents)
            if column > 0:
                self.headerItem().setTextAlignment(column, QtCore.Qt.AlignRight | QtCore.Qt.AlignVCenter)

    def add_row(self, texts):
        """Adds a row; numbers are right-aligned."""
        row = QtGui.QTreeWidgetItem(self, texts)
        for column in range(1, len(texts)):
            row.setTextAlignment(column, QtCore.Qt.AlignRight | QtCore.Qt.AlignVCenter)
        return row

    def fit(self):
        """Fits the table's height and columns to its rows and its width."""
        rows = min(self._most, self.topLevelItemCount())
        around = self.height() - self.viewport().height()
        self.setFixedHeight(around + rows * max(1, self.sizeHintForRow(0)) + SPARE)
        header = self.header()
        others = sum(header.sectionSize(column) for column in range(1, header.count()))
        header.setSectionResizeMode(0, QtGui.QHeaderView.Fixed)
        header.resizeSection(0, max(self.sizeHintForColumn(0), self.viewport().width() - others))

    def resizeEvent(self, event):
        super().resizeEvent(event)
        self.fit()

    def showEvent(self, event):
        super().showEvent(event)
        self.fit()
