using System;

namespace UnityEngine
{
    public sealed class WaitForFixedUpdate
    {
    }
}

namespace UnityEngine.TestTools
{
    [AttributeUsage(AttributeTargets.Method)]
    public sealed class UnityTestAttribute : Attribute
    {
    }

    public static class LogAssert
    {
        public static bool ignoreFailingMessages { get; set; }
    }
}

namespace UnityEditor
{
    /// <summary>Tests of the editor compile against it and run in the editor alone.</summary>
    public struct GlobalObjectId
    {
        public static GlobalObjectId GetGlobalObjectIdSlow(UnityEngine.Object targetObject) => throw new NotSupportedException();
    }
}
