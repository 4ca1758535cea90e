"""The numbers that the paper prints (tables 1 and 2, and those in figures), for the page of results.

Milliseconds are of an RX 9070 XT: a training step, and 1920x1080 answers. MB are of parameters only. Scenes: Bistro's exterior
and interior, a bathroom, the Country Kitchen."""

# integrator, scene: encoding: (training ms, inference ms, MB, FLIP), 128 steps.
TABLE1 = {
    ("nao", "Bistro exterior"): {"gate": (0.45, 0.70, 177.09, 0.040), "hash grid": (25.32, 2.05, 189.59, 0.065)},
    ("nao", "Bistro interior"): {"gate": (0.38, 0.70, 16.00, 0.038), "hash grid": (3.41, 1.91, 17.55, 0.041)},
    ("nao", "Bathroom"): {"gate": (0.38, 0.66, 0.67, 0.021), "hash grid": (1.25, 1.65, 0.66, 0.021)},
    ("nao", "Country Kitchen"): {"gate": (0.40, 0.70, 9.92, 0.033), "hash grid": (2.40, 1.92, 9.37, 0.034)},
    ("nrc", "Bistro exterior"): {"gate": (1.43, 1.25, 365.46, 0.323), "hash grid": (41.56, 2.53, 328.85, 0.382)},
    ("nrc", "Bistro interior"): {"gate": (1.37, 1.24, 50.00, 0.854), "hash grid": (6.97, 2.11, 46.22, 0.985)},
    ("nrc", "Bathroom"): {"gate": (1.45, 0.88, 2.47, 0.414), "hash grid": (1.86, 1.76, 2.45, 0.409)},
    ("nrc", "Country Kitchen"): {"gate": (1.41, 0.91, 29.76, 0.333), "hash grid": (4.87, 1.83, 29.84, 0.348)},
}

# Bistro exterior; row: (training ms, inference ms, MB, FLIP).
TABLE2 = {
    "nao": {"gate": (0.45, 0.70, 177.09, 0.040), "hash grid L": (25.30, 2.05, 189.89, 0.065),
            "hash grid M": (11.66, 2.02, 83.09, 0.074), "hash grid S": (1.66, 1.92, 0.91, 0.122)},
    "nrc": {"gate": (1.43, 1.23, 365.56, 0.403), "hash grid L": (41.54, 2.53, 328.85, 0.407),
            "hash grid M": (17.63, 2.54, 132.24, 0.465), "hash grid S": (1.98, 2.03, 0.91, 0.461)},
}

# Country Kitchen, resolution 4 everywhere and adaptive: MB.
ADAPTIVE_MB = (75.0, 20.0)
