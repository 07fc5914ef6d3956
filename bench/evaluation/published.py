"""The numbers that the paper prints in its tables 2, 3 and 4. Its machine had a Core i7 of 3.33 GHz and a GTX 580."""
from typing import NamedTuple


class Row(NamedTuple):
    """A surface: crossed cells and faces of table 3, the rest of table 4. Seconds, and 10^6 bytes."""
    model: str
    iso: int
    crossed: int
    percent: float
    faces: int
    left: int
    extraction: float
    simplification: float
    memory: float

    @property
    def name(self):
        return f"{self.model} ({self.iso})"

    @property
    def ratio(self):
        return self.left / self.faces


# Table 2: samples along the three axes, of which the second is swept, and the megabytes of the file.
MODELS = {"bonsai #2": ((512, 189, 512), 48.384), "CTA head": ((512, 120, 512), 30.720),
          "Porsche": ((559, 347, 1023), 193.784)}

ROWS = (
    Row("bonsai #2", 20, 2_203_645, 4.49, 4_405_952, 4_396_060, 4.09, 5.74, 480.5),
    Row("bonsai #2", 25, 1_125_808, 2.29, 2_252_046, 2_245_412, 3.99, 2.86, 430.6),
    Row("bonsai #2", 50, 329_858, 0.67, 658_158, 658_158, 3.78, 0.95, 394.7),
    Row("CTA head", 50, 956_441, 3.08, 1_913_256, 1_845_976, 2.58, 1.19, 423.4),
    Row("CTA head", 60, 2_961_041, 9.53, 5_878_764, 1_216_734, 2.62, 5.31, 514.2),
    Row("CTA head", 250, 694_745, 2.24, 1_392_432, 1_392_432, 2.58, 1.37, 411.5),
    Row("Porsche", 14, 4_744_499, 2.40, 9_580_084, 4_140_690, 15.34, 21.12, 923.2),
)
