namespace Kinefab.Json;

/// <summary>Kinds of JSON tokens (RFC 8259).</summary>
internal enum JsonToken : byte
{
    /// <summary>Nothing was read yet.</summary>
    None,
    StartObject,
    EndObject,
    StartArray,
    EndArray,
    PropertyName,
    String,
    Number,
    True,
    False,
    Null,
}
