using System.Runtime.CompilerServices;

[assembly: InternalsVisibleTo("Kinefab.Unity.Editor")]
[assembly: InternalsVisibleTo("Kinefab.Unity.Tests")]
[assembly: InternalsVisibleTo("Kinefab.Unity.Editor.Tests")]
[assembly: InternalsVisibleTo("Kinefab.Tests")]
