using NUnit.Framework;

namespace Kinefab.NUnit;

/// <summary><c>Is.ValidScene</c>.</summary>
public static class IsExtensions
{
    extension(Is)
    {
        /// <summary>A scene without errors. What is tested is the path of its file, or what <see cref="Document.SceneFile"/> read.</summary>
        public static ValidSceneConstraint ValidScene => new();
    }
}
