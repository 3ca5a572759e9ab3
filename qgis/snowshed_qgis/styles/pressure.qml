<!DOCTYPE qgis PUBLIC 'http://mrcc.com/qgis.dtd' 'SYSTEM'>
<qgis version="3.22" styleCategories="Symbology">
  <pipe>
    <rasterrenderer type="singlebandpseudocolor" band="1" opacity="0.85" classificationMin="0" classificationMax="300" alphaBand="-1">
      <rastershader>
        <colorrampshader colorRampType="DISCRETE" classificationMode="1" clip="0" minimumValue="0" maximumValue="300">
          <item value="0.01" color="#ffffff" alpha="0" label=""/>
          <item value="1.0" color="#e3d9eb" alpha="255" label="0.01 to 1 kPa"/>
          <item value="3.0" color="#d0add4" alpha="255" label="1 to 3 kPa"/>
          <item value="10.0" color="#d37fbd" alpha="255" label="3 to 10 kPa"/>
          <item value="30.0" color="#e44099" alpha="255" label="10 to 30 kPa"/>
          <item value="100.0" color="#d41863" alpha="255" label="30 to 100 kPa"/>
          <item value="300.0" color="#9f0245" alpha="255" label="100 to 300 kPa"/>
          <item value="inf" color="#67001f" alpha="255" label="above 300 kPa"/>
        </colorrampshader>
      </rastershader>
    </rasterrenderer>
  </pipe>
  <blendMode>0</blendMode>
</qgis>
