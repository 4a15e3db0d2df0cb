using System.Runtime.CompilerServices;

[assembly: InternalsVisibleTo("Kinefab.Unity.Editor.Tests")]
[assembly: InternalsVisibleTo("Kinefab.Tests")]
