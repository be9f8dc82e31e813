"""Rewriting a plain Python function for the types of its arguments, before numba compiles it.

Types decide `if scene.effects.gravity is None`, `for k in range(len(x))` and
`for part in present(effects, "restitution")`: the number of components of a vector, and the effects
of a scene. Only the rest is compiled. An absent effect leaves no instruction, and the compiler
keeps each component of a vector, a tuple, in a register.
`python -m roughgas.kernel --show FUNCTION --scene EXPERIMENT` prints the result.

Known types are those of arguments, of their fields and items (`state.sweep.sizes`), and of names
that are assigned once, to such a value or to `by_reference` of an argument. If they do not decide
`is None`, the function is refused, since that would be a branch at run time. Other tests stay.
"""

import ast
from types import SimpleNamespace

LOAD_FIELD, MARK_INLINED = "load_field", "mark_inlined"
"""Names by which functions that are specialised for the public path call struct_pointer.load_field
and public_numba.mark_inlined."""


def is_none(numba_type):
    """Return whether a type of numba's is the type of None."""
    return str(numba_type) == "none"


def field_type(numba_type, step):
    """Return the type of a field, by its name, or of an item, by its index, of a type of numba's.

    None if it is unknown. Raises TypeError for a field that a NamedTuple lacks.
    """
    fields = getattr(getattr(numba_type, "instance_class", None), "_fields", ())
    if isinstance(step, str):
        if fields and step not in fields:
            raise TypeError(f"{numba_type.instance_class.__name__} has no {step}")
        return numba_type.types[fields.index(step)] if fields else None
    return numba_type.types[step] if hasattr(numba_type, "types") else None


def _ends_in_jump(statements):
    jumps = ast.Return | ast.Raise | ast.Break | ast.Continue
    return statements[-1:] and isinstance(statements[-1], jumps)


class Specialiser(ast.NodeTransformer):
    """Rewrites the definition of a function for types; the original nodes are not changed.

    `namespace` holds the globals and closure variables of the function; a function that is named as
    an attribute of a constant is added to it. With `load_field`, the name of a function, a field or
    an item of a StructPointer becomes a call of it: `state.clock` becomes `load_field(state, 3)`.

    `_bindings` maps names to types of numba's, or to constants as nodes. A name that is assigned
    more than once is not in it.
    """

    def __init__(self, definition, argument_types, namespace, load_field=None):
        self.namespace, self._function_name = namespace, definition.name
        self._load_field = load_field
        parameters = [*definition.args.args, definition.args.vararg][: len(argument_types)]
        nodes = [node for node in ast.walk(definition) if isinstance(node, ast.Name)]
        assigned = [node.id for node in nodes if isinstance(node.ctx, ast.Store)]
        self._assigned_once = {name for name in assigned if assigned.count(name) == 1}
        names = [parameter.arg for parameter in parameters]
        self._argument_types = dict(zip(names, argument_types, strict=True))
        self._bindings = {k: v for k, v in self._argument_types.items() if k not in assigned}

    def visit(self, node):
        """Return the node's replacement; of a statement it may be a list."""
        new = super().visit(node)
        return new if isinstance(new, list) else ast.copy_location(new, node)

    def generic_visit(self, node):
        """Return a copy of the node with its children visited; of constant operands its value."""
        new = type(node)(**{name: self._visited(value) for name, value in ast.iter_fields(node)})
        operands = [child for child in ast.iter_child_nodes(new) if isinstance(child, ast.expr)]
        is_constant = all(isinstance(getattr(x, "value", None), int) for x in operands)
        if is_constant and isinstance(node, ast.BinOp | ast.UnaryOp | ast.Compare):
            expression = ast.fix_missing_locations(ast.Expression(new))
            return ast.Constant(eval(compile(expression, self._function_name, "eval")))
        return new

    def _visited(self, value):
        if isinstance(value, list):
            return [self._visited(child) for child in value]
        return self.visit(value) if isinstance(value, ast.AST) else value

    # ------------------------------------------------------------------ statements

    def visit_FunctionDef(self, node):
        return ast.FunctionDef(node.name, node.args, self._block(node.body), [])

    def _block(self, statements):
        """Return specialised statements, up to the first return or other jump."""
        block = []
        for statement in statements:
            new = self.visit(statement)
            block += new if isinstance(new, list) else [new]
            if _ends_in_jump(block):
                break
        return block or [ast.Pass()]

    def visit_If(self, node):
        test = self._test(node.test)
        if isinstance(test, ast.Constant):
            chosen = node.body if test.value else node.orelse
            return self._block(chosen) if chosen else []
        return ast.If(test, self._block(node.body), self._block(node.orelse) if node.orelse else [])

    def visit_While(self, node):
        return ast.While(self._test(node.test), self._block(node.body), [])

    def visit_For(self, node):
        values = self.visit(node.iter)
        if not isinstance(values, ast.Constant):
            return ast.For(node.target, values, self._block(node.body), [])
        if any(isinstance(child, ast.Break | ast.Continue) for child in ast.walk(node)):
            self._refuse(node.iter, "what is written out has no break and no continue")
        unrolled = []
        for _ in self._iterate(node, values):
            unrolled += [] if _ends_in_jump(unrolled) else self._block(node.body)
        return unrolled

    def _iterate(self, loop, values):
        """Go through the constant values of a loop; its target is known to be each in turn."""
        outer = self._bindings
        for value in values.value:
            self._bindings = outer | {loop.target.id: ast.Constant(value)}
            yield value
        self._bindings = outer

    def visit_Assign(self, node):
        new, (target,) = self.generic_visit(node), node.targets
        pairs = [(target, new.value)]
        if isinstance(target, ast.Tuple) and isinstance(new.value, ast.Tuple):
            pairs = zip(target.elts, new.value.elts, strict=True)
        for name, value in pairs:
            is_constant = isinstance(value, ast.Constant) and isinstance(value.value, int | None)
            binding = value if is_constant else self._type(value)
            if getattr(name, "id", None) in self._assigned_once and binding is not None:
                self._bindings |= {name.id: binding}
        return new

    # ------------------------------------------------------------------ expressions

    def _type(self, node):
        """Return the type of an expression, None if it is unknown."""
        if isinstance(node, ast.Constant) and node.value is None:
            return "none"
        if isinstance(node, ast.Name):
            return self._bindings.get(node.id)
        if isinstance(node, ast.Attribute):
            return field_type(self._type(node.value), node.attr)
        if isinstance(node, ast.Subscript) and isinstance(node.slice, ast.Constant):
            return field_type(self._type(node.value), node.slice.value)
        if isinstance(node, ast.Tuple):
            return SimpleNamespace(types=[self._type(element) for element in node.elts])
        if isinstance(node, ast.Call):
            return self._result_type(node)
        return None

    def _result_type(self, call):
        """Return the type of a call's result, None if it is unknown."""
        name = getattr(call.func, "id", "")
        if name == self._load_field:
            struct, index = call.args
            return field_type(self._type(struct), index.value)
        function = self.namespace.get(name)
        if getattr(function, "is_primitive", False) and function.result_type:
            # by_reference, whose result may take the name of its argument
            (argument,) = call.args
            numba_type = self._type(argument) or self._argument_types.get(argument.id)
            return numba_type and function.result_type(numba_type)
        return None

    def _refuse(self, node, why):
        location = f"{self._function_name}, line {node.lineno}"
        raise TypeError(f"{location}: {ast.unparse(node)}: {why}")

    def _test(self, node):
        """Return a test, decided or not. Raises TypeError for None or a tuple as truth value."""
        test = self.visit(node)
        operand_type = self._type(test.operand if isinstance(test, ast.UnaryOp) else test)
        if isinstance(test, ast.Constant):
            return test
        if is_none(operand_type) or hasattr(operand_type, "types"):
            self._refuse(node, "a test must say `is None`")
        return test

    def visit_Name(self, node):
        binding = self._bindings.get(node.id) if isinstance(node.ctx, ast.Load) else None
        return binding if isinstance(binding, ast.Constant) else node

    def visit_Attribute(self, node):
        new = self.generic_visit(node)
        if not isinstance(new.value, ast.Constant):
            return self._loaded(new, node.attr)
        value = getattr(new.value.value, node.attr)
        if not callable(value):
            return ast.Constant(value)
        name = f"{value.__module__}.{value.__name__}".replace(".", "_")
        while self.namespace.setdefault(name, value) is not value:  # another function of this name
            name += "_"
        return ast.Name(name, node.ctx)

    def visit_Subscript(self, node):
        new = self.generic_visit(node)
        return self._loaded(new, new.slice.value) if isinstance(new.slice, ast.Constant) else new

    def _loaded(self, node, step):
        """Return a call that loads a field or an item of a StructPointer; other nodes as such."""
        if self._load_field is None or not isinstance(node.ctx, ast.Load):
            return node
        struct_type = self._type(node.value)
        if not getattr(struct_type, "is_struct_pointer", False):
            return node
        index = struct_type.fields.index(step) if isinstance(step, str) else step
        function = ast.Name(self._load_field, ast.Load())
        return ast.Call(function, [node.value, ast.Constant(index)], [])

    def visit_IfExp(self, node):
        test = self._test(node.test)
        if isinstance(test, ast.Constant):
            return self.visit(node.body if test.value else node.orelse)
        return ast.IfExp(test, self.visit(node.body), self.visit(node.orelse))

    def visit_BoolOp(self, node):
        decisive, remaining = isinstance(node.op, ast.Or), []
        for value in node.values:
            test = self._test(value)
            if not isinstance(test, ast.Constant):
                remaining.append(test)
            elif bool(test.value) == decisive:
                remaining.append(test)
                break
        if remaining[1:]:
            return ast.BoolOp(node.op, remaining)
        return (remaining or [ast.Constant(not decisive)])[0]

    def visit_Compare(self, node):
        new = self.generic_visit(node)
        if not isinstance(node.ops[0], ast.Is | ast.IsNot) or isinstance(new, ast.Constant):
            return new
        left_type = self._type(new.left)
        if left_type is None and not isinstance(new.left, ast.Constant):
            self._refuse(node, "types do not decide it")
        return ast.Constant(is_none(left_type) == isinstance(node.ops[0], ast.Is))

    def visit_Call(self, node):
        name = getattr(node.func, "id", "")
        if name == "tuple" and isinstance(node.args[0], ast.GeneratorExp):
            return self._tuple(node.args[0])
        new = self.generic_visit(node)
        constants = [x.value for x in new.args if isinstance(x, ast.Constant)]
        operands = [x.value if isinstance(x, ast.Constant) else self._type(x) for x in new.args]
        if name == "len" and hasattr(operands[0], "types"):
            return ast.Constant(len(operands[0].types))
        if name == "range" and len(constants) == len(operands) and ast.dump(new) != ast.dump(node):
            return ast.Constant(range(*operands))
        if hasattr(function := self.namespace.get(name), "is_static"):
            if None in operands:
                self._refuse(node, "types do not decide it")
            return ast.Constant(function(*operands))
        return new

    def _tuple(self, node):
        """Return the elements of tuple(... for k in range(...) if ...), written out."""
        (loop,) = node.generators
        values = self.visit(loop.iter)
        if not isinstance(values, ast.Constant):
            self._refuse(loop.iter, "types do not decide it")
        chosen = (all(self._test(x).value for x in loop.ifs) for _ in self._iterate(loop, values))
        return ast.Tuple([self.visit(node.elt) for is_chosen in chosen if is_chosen], ast.Load())
