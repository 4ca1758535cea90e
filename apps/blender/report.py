"""What cannot be carried over: each thing is named once in a render."""


class Notes:
    """Lines in the order in which they came, without repetitions."""

    def __init__(self):
        self.lines = []

    def add(self, what, text):
        line = f"{what}: {text}"
        if line not in self.lines:
            self.lines.append(line)

    def print(self):
        for line in self.lines:
            print(f"Gatelight: {line}")

    def summary(self):
        """One line for the status, or nothing."""
        if not self.lines:
            return ""
        more = f" (and {len(self.lines) - 1} more in the console)" if len(self.lines) > 1 else ""
        return f"Not carried over: {self.lines[0]}{more}"
