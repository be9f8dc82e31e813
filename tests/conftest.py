"""What all tests share; its being here also lets them import `synthetic`."""

from hypothesis import settings

# how long an example takes says nothing where compilers and other jobs share the cores
settings.register_profile("shared machine", deadline=None)
settings.load_profile("shared machine")
