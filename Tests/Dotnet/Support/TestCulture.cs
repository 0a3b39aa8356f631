using System;
using System.Globalization;
using System.Reflection;
using NUnit.Framework;

/// <summary>Every test runs in a language that writes differently: those of the editor with another minus sign, other marks
/// in numbers and another calendar (Persian), the others with another letter i (Turkish). The variable
/// HAPTOFLOW_TEST_CULTURE names another language. Without a namespace, so that it is set up before everything.</summary>
[SetUpFixture]
public sealed class TestCulture
{
    [OneTimeSetUp]
    public void Choose()
    {
        bool isOfEditor = Assembly.GetExecutingAssembly().GetName().Name == "HaptoFlow.EditorTests";
        string? named = Environment.GetEnvironmentVariable("HAPTOFLOW_TEST_CULTURE");
        string name = !string.IsNullOrEmpty(named) ? named : isOfEditor ? "fa-IR" : "tr-TR";
        var culture = new CultureInfo(name);
        if (culture.NumberFormat.NumberDecimalSeparator == ".")
        {
            throw new InvalidOperationException(
                $"{name} writes numbers as every language does here: .NET lacks ICU (libicu), or runs without cultures");
        }
        CultureInfo.CurrentCulture = culture;
        CultureInfo.CurrentUICulture = culture;
        CultureInfo.DefaultThreadCurrentCulture = culture;
        CultureInfo.DefaultThreadCurrentUICulture = culture;
    }
}
