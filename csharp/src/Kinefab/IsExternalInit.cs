#if !NET5_0_OR_GREATER
namespace System.Runtime.CompilerServices;

/// <summary>Lets the compiler write init-only properties for netstandard2.1, which does not bring this type.</summary>
internal static class IsExternalInit
{
}
#endif
