using System;

namespace Kinefab.Reading;

/// <summary>Ends the reading of a text whose fault is already reported; never leaves the library.</summary>
internal sealed class ReadingEndedException : Exception
{
}
