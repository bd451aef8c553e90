"""The type, property values and identifying names of a document's objects."""


def type_of(obj):
    """Returns the `Type` of an object's proxy; "" if it has none."""
    return getattr(getattr(obj, "Proxy", None), "Type", "")


def value_of(obj, name, *default):
    """Returns a property's value; that of a quantity is in millimetres or degrees. If the object lacks the property,
    returns `default` or, without one, raises AttributeError."""
    value = getattr(obj, name, *default)
    return getattr(value, "Value", value)


def key_of(obj):
    """Returns the names of an object's document and of the object, which identify it while it exists."""
    return obj.Document.Name, obj.Name
