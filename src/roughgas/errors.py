"""The one error that bad input raises."""


class InputError(ValueError):
    """A value that is not legal: `key` names it, `legal` completes the sentence "it must ...".

    Its text is one line: `restitution r = 1.5: must lie in [0, 1]`.
    """

    def __init__(self, key: str, value: object, legal: str) -> None:
        super().__init__(key, value, legal)
        self.key = key
        self.value = value
        self.legal = legal

    def __str__(self) -> str:
        return f"{self.key} = {self.value}: must {self.legal}"


class CollapseError(RuntimeError):
    """Inelastic collapse: contacts without end in a finite time. Its text is one line."""
